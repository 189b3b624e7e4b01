// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by forces on the boundary: springs, penalty and Nitsche's method.

#include <softcell/loads/supports.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

namespace softcell
{
  namespace
  {
    Matrix3<double>
    deformation_gradient(const SurfacePatch &patch, const unsigned int q, const Vector &u)
    {
      const Gradient gradient = interpolate_gradient(patch.nodes, patch.shapes.gradient(q), u);
      Matrix3<double> F       = identity<double>();
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          F(a, b) += gradient[a][b];
      return F;
    }
  } // namespace

  Support::Support(const Discretization &discretization,
                   std::vector<SurfacePatch> patches,
                   Expression displacement,
                   std::string region)
      : discretization_(discretization),
        patches_(std::move(patches)),
        displacement_(std::move(displacement)),
        region_(std::move(region))
  {
  }

  void Support::add_couplings(std::vector<std::vector<unsigned int>> &couplings) const
  {
    for (const SurfacePatch &patch : patches_)
      couplings.push_back(patch.nodes);
  }

  Direction Support::misfit(const SurfacePatch &patch,
                            const unsigned int q,
                            const Vector &u,
                            const double t) const
  {
    Direction gap = interpolate(patch.nodes, patch.shapes.value(q), u) -
                    displacement_.at_load_factor(patch.points[q], t);
    for (unsigned int c = 0; c < 3; ++c)
      if (displacement_.is_free(c))
        gap[c] = 0;
    return gap;
  }

  Penalty::Penalty(const Discretization &discretization,
                   std::vector<SurfacePatch> patches,
                   Expression displacement,
                   Expression stiffness,
                   std::string region)
      : Support(discretization, std::move(patches), std::move(displacement), std::move(region)),
        stiffness_(std::move(stiffness))
  {
  }

  void Penalty::add_residual(const Vector &u, const double t, Vector &r) const
  {
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const double k          = stiffness_.value(patch.points[q], t)[0];
        const Direction minus_f = k * patch.weights[q] * misfit(patch, q, u, t);
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            r.local_element(3 * patch.nodes[i] + c) += minus_f[c] * patch.shapes.value(q)[i];
      }
  }

  void Penalty::add_tangent(const Vector & /*u*/, const double t, BlockMatrix &K) const
  {
    std::vector<double> values;
    for (const SurfacePatch &patch : patches_)
    {
      const unsigned int n = patch.nodes.size();
      values.assign(9 * n * n, 0.);
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const double k_weight = stiffness_.value(patch.points[q], t)[0] * patch.weights[q];
        const double *const N = patch.shapes.value(q);
        for (unsigned int c = 0; c < 3; ++c)
          if (!displacement_.is_free(c))
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                values[((c * n + i) * 3 + c) * n + j] += k_weight * N[i] * N[j];
      }
      K.add(patch.nodes, values.data());
    }
  }

  double Penalty::energy(const Vector &u, const double t) const
  {
    double sum = 0;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        sum += 0.5 * stiffness_.value(patch.points[q], t)[0] * patch.weights[q] *
               misfit(patch, q, u, t).norm_square();
    return dealii::Utilities::MPI::sum(sum, discretization_.communicator());
  }

  Direction Penalty::total_force(const Vector &u, const double t) const
  {
    Direction total;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        total -=
          stiffness_.value(patch.points[q], t)[0] * patch.weights[q] * misfit(patch, q, u, t);
    return dealii::Utilities::MPI::sum(total, discretization_.communicator());
  }

  Nitsche::Nitsche(const Discretization &discretization,
                   std::vector<SurfacePatch> patches,
                   Expression displacement,
                   const std::vector<Material> &materials,
                   const double factor,
                   std::string region)
      : Support(discretization, std::move(patches), std::move(displacement), std::move(region)),
        materials_(materials),
        factor_(factor)
  {
  }

  Nitsche::Terms Nitsche::terms(const SurfacePatch &patch,
                                const unsigned int q,
                                const Vector &u,
                                const double t) const
  {
    const Matrix3<double> F = deformation_gradient(patch, q, u);
    const Direction &N      = patch.normals[q];
    Terms terms;
    terms.misfit = misfit(patch, q, u, t);
    Matrix3<double> misfit_N, P, change;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        misfit_N(a, b) = terms.misfit[a] * N[b];
    materials_[patch.labels[q]].visit([&](const auto &law) {
      P               = law.first_piola_stress(F);
      change          = law.linearisation(F)(misfit_N);
      terms.stiffness = factor_ * discretization_.degree() * discretization_.degree() *
                        (law.lambda + 2 * law.mu) / patch.cell_size;
    });
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
      {
        if (!displacement_.is_free(a))
          terms.traction[a] += P(a, b) * N[b];
        terms.change[a][b] = change(a, b);
      }
    return terms;
  }

  void Nitsche::check_admissible(const Vector &u) const
  {
    bool is_inverted = false;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        materials_[patch.labels[q]].visit([&](const auto &law) {
          is_inverted |= !law.is_admissible(determinant(deformation_gradient(patch, q, u)));
        });
    if (dealii::Utilities::MPI::logical_or(is_inverted, discretization_.communicator()))
      throw InvertedPoint("the displacement inverts the body on region '" + region() + "'");
  }

  // dP[e_c (x) G_i] N . misfit is, by the major symmetry of dP/dF, row c of `change` times G_i.
  void Nitsche::add_residual(const Vector &u, const double t, Vector &r) const
  {
    check_admissible(u);
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const Terms at_q        = terms(patch, q, u, t);
        const unsigned int n    = patch.nodes.size();
        const double *const N   = patch.shapes.value(q);
        const double *const G   = patch.shapes.gradient(q);
        const Direction minus_f = at_q.stiffness * at_q.misfit - at_q.traction;
        for (unsigned int i = 0; i < n; ++i)
        {
          const Direction G_i({G[i], G[n + i], G[2 * n + i]});
          for (unsigned int c = 0; c < 3; ++c)
            r.local_element(3 * patch.nodes[i] + c) +=
              patch.weights[q] * (minus_f[c] * N[i] - at_q.change[c] * G_i);
        }
      }
  }

  void Nitsche::add_tangent(const Vector &u, const double t, BlockMatrix &K) const
  {
    std::vector<double> values;
    std::vector<Gradient> B; // [j][b][a] = component a of dP[e_b (x) G_j] N, 0 where g is free
    for (const SurfacePatch &patch : patches_)
    {
      const unsigned int n = patch.nodes.size();
      values.assign(9 * n * n, 0.);
      B.resize(n);
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const Matrix3<double> F = deformation_gradient(patch, q, u);
        const double *const N   = patch.shapes.value(q);
        const double *const G   = patch.shapes.gradient(q);
        materials_[patch.labels[q]].visit([&](const auto &law) {
          const auto tangent = law.linearisation(F);
          for (unsigned int j = 0; j < n; ++j)
            for (int b = 0; b < 3; ++b)
            {
              const Matrix3<double> dP =
                tangent(NodalGradient<double>{b, {G[j], G[n + j], G[2 * n + j]}});
              for (unsigned int a = 0; a < 3; ++a)
              {
                const Direction row({dP(a, 0), dP(a, 1), dP(a, 2)});
                B[j][b][a] = displacement_.is_free(a) ? 0. : row * patch.normals[q];
              }
            }
        });
        const double stiffness = terms(patch, q, u, t).stiffness;
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int b = 0; b < 3; ++b)
              for (unsigned int j = 0; j < n; ++j)
              {
                double value = -N[i] * B[j][b][a] - N[j] * B[i][a][b];
                if (a == b && !displacement_.is_free(a))
                  value += stiffness * N[i] * N[j];
                values[((a * n + i) * 3 + b) * n + j] += patch.weights[q] * value;
              }
      }
      K.add(patch.nodes, values.data());
    }
  }

  double Nitsche::energy(const Vector &u, const double t) const
  {
    check_admissible(u);
    double sum = 0;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const Terms at_q = terms(patch, q, u, t);
        sum +=
          patch.weights[q] * (0.5 * at_q.stiffness * at_q.misfit - at_q.traction) * at_q.misfit;
      }
    return dealii::Utilities::MPI::sum(sum, discretization_.communicator());
  }

  Direction Nitsche::total_force(const Vector &u, const double t) const
  {
    Direction total;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const Terms at_q = terms(patch, q, u, t);
        total += patch.weights[q] * (at_q.traction - at_q.stiffness * at_q.misfit);
      }
    return dealii::Utilities::MPI::sum(total, discretization_.communicator());
  }
} // namespace softcell
