// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by Nitsche's method.

#include <softcell/loads/nitsche.h>

#include <softcell/base/exceptions.h>
#include <softcell/discretization/orthonormal_polynomials.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace softcell
{
  namespace
  {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// Projects the gradients of a surface's shapes as Nitsche says.
    /// @return the constant C of this piece. Units: 1/m
    double project_gradients(const Discretization &discretization, SurfacePatch &surface)
    {
      PatchStorage storage;
      const Patch cell = discretization.patch(surface.cell, storage);
      std::vector<Point> points;
      discretization.patch_points(surface.cell, points);
      points.insert(points.end(), surface.points.begin(), surface.points.end());

      const unsigned int n = 3 * cell.n_nodes(), n_cell = cell.n_points();
      std::fill(surface.shapes.gradients.begin(), surface.shapes.gradients.end(), 0.);
      double constant = 0;
      std::vector<double> moment(n), polynomials;
      orthonormal_polynomials(points, cell.weights, discretization.degree() - 1, polynomials);
      for (auto phi = polynomials.begin(); phi != polynomials.end(); phi += points.size())
      {
        std::fill(moment.begin(), moment.end(), 0.);
        for (unsigned int q = 0; q < n_cell; ++q)
          for (unsigned int i = 0; i < n; ++i)
            moment[i] += cell.weights[q] * phi[q] * cell.shapes->gradient(q)[i];
        for (unsigned int q = 0; q < surface.points.size(); ++q)
        {
          for (unsigned int i = 0; i < n; ++i)
            surface.shapes.gradients[q * n + i] += phi[n_cell + q] * moment[i];
          constant += surface.weights[q] * phi[n_cell + q] * phi[n_cell + q];
        }
      }
      return constant;
    }
  } // namespace

  Nitsche::Nitsche(const Discretization &discretization,
                   std::vector<SurfacePatch> patches,
                   Expression displacement,
                   const std::vector<Material> &materials,
                   const double factor,
                   std::string region)
      : Support(discretization, std::move(patches), std::move(displacement), std::move(region)),
        materials_(materials)
  {
    std::map<unsigned int, double> constants; // of cells, of all their pieces of surface
    for (SurfacePatch &patch : patches_)
      constants[patch.cell] += project_gradients(discretization, patch);
    for (const SurfacePatch &patch : patches_)
    {
      const double wanted    = factor * constants[patch.cell];
      const double stiffness = std::min(wanted, limit / patch.cell_size);
      const double flux      = std::sqrt(stiffness / wanted);
      factors_.push_back({stiffness, flux, 1 / (4 * flux * constants[patch.cell])});
    }
  }

  Nitsche::Terms
  Nitsche::terms(const unsigned int p, const unsigned int q, const Vector &u, const double t) const
  {
    const SurfacePatch &patch = patches_[p];
    const Direction &N        = patch.normals[q];
    Terms terms;
    terms.F = deformation_gradient(interpolate_gradient(patch.nodes, patch.shapes.gradient(q), u));
    terms.misfit = misfit(patch, q, u, t);
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        terms.misfit_N(a, b) = factors_[p].flux * terms.misfit[a] * N[b];
    materials_[patch.labels[q]].visit([&](const auto &law) {
      const Matrix3<double> P = law.first_piola_stress(terms.F);
      for (unsigned int a = 0; a < 3; ++a)
        if (!displacement_.is_free(a))
          terms.traction[a] = factors_[p].flux * dot(P, a, N.begin_raw());
      terms.change = law.linearisation(terms.F)(terms.misfit_N);
    });
    terms.stiffness = factors_[p].stiffness * materials_[patch.labels[q]].longitudinal_modulus();
    return terms;
  }

  void Nitsche::check_admissible(const Vector &u) const
  {
    bool is_inverted = false;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        materials_[patch.labels[q]].visit([&](const auto &law) {
          is_inverted |= !law.is_admissible(determinant(
            deformation_gradient(interpolate_gradient(patch.nodes, patch.shapes.gradient(q), u))));
        });
    if (dealii::Utilities::MPI::logical_or(is_inverted, discretization_.communicator()))
      throw InvertedPoint("the displacement inverts the body on region '" + region() + "'");
  }

  // dP[e_c (x) G_i] N . misfit is, by the major symmetry of dP/dF, row c of `change` times G_i.
  void Nitsche::add_residual(const Vector &u, const double t, Vector &r) const
  {
    check_admissible(u);
    for (unsigned int p = 0; p < patches_.size(); ++p)
      for (unsigned int q = 0; q < patches_[p].points.size(); ++q)
      {
        const SurfacePatch &patch = patches_[p];
        const Terms at_q          = terms(p, q, u, t);
        const unsigned int n      = patch.nodes.size();
        const double *const N     = patch.shapes.value(q);
        const double *const G     = patch.shapes.gradient(q);
        const Direction minus_f   = at_q.stiffness * at_q.misfit - at_q.traction;
        for (unsigned int i = 0; i < n; ++i)
        {
          const double G_i[] = {G[i], G[n + i], G[2 * n + i]};
          for (unsigned int c = 0; c < 3; ++c)
            r.local_element(3 * patch.nodes[i] + c) +=
              patch.weights[q] * (minus_f[c] * N[i] - dot(at_q.change, c, G_i));
        }
      }
  }

  void Nitsche::add_tangent(const Vector &u, const double t, BlockMatrix &K) const
  {
    RowMajor shapes, changes, values;
    for (unsigned int p = 0; p < patches_.size(); ++p)
    {
      const SurfacePatch &patch = patches_[p];
      const unsigned int n = patch.nodes.size(), n_points = patch.points.size();
      shapes.resize(4 * n_points, n);
      changes.resize(12 * n_points, 3 * n); // of component a from row 4 n_points a on
      values.resize(3 * n, 3 * n);
      for (unsigned int q = 0; q < n_points; ++q)
      {
        shapes.row(4 * q) = Eigen::Map<const Eigen::RowVectorXd>(patch.shapes.value(q), n);
        shapes.middleRows<3>(4 * q + 1) =
          Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>(
            patch.shapes.gradient(q), 3, n);
        const PointTangent M = tangent(p, q, terms(p, q, u, t));
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b < 3; ++b)
            changes.block(4 * (n_points * a + q), b * n, 4, n) =
              M.block<4, 4>(4 * a, 4 * b).lazyProduct(shapes.middleRows<4>(4 * q));
      }
      for (unsigned int a = 0; a < 3; ++a)
        values.middleRows(a * n, n).noalias() =
          shapes.transpose() * changes.middleRows(4 * n_points * a, 4 * n_points);
      K.add(patch.nodes, values.data());
    }
  }

  Nitsche::PointTangent
  Nitsche::tangent(const unsigned int p, const unsigned int q, const Terms &at_q) const
  {
    const double step  = 1e-6; // no law offers third derivatives of its energy
    const Direction &N = patches_[p].normals[q];
    PointTangent M     = PointTangent::Zero();
    materials_[patches_[p].labels[q]].visit([&](const auto &law) {
      const auto linearisation = law.linearisation(at_q.F);
      const bool is_near =
        at_q.misfit.norm() <= factors_[p].largest_misfit * law.mu / (law.lambda + 2 * law.mu);
      for (unsigned int b = 0; b < 3; ++b)
        for (unsigned int B = 0; B < 3; ++B)
        {
          const unsigned int column = 4 * b + 1 + B;
          Matrix3<double> dF{};
          dF(b, B)                 = 1;
          const Matrix3<double> dP = linearisation(dF);
          for (unsigned int a = 0; a < 3; ++a)
            if (!displacement_.is_free(a))
              M(4 * a, column) = M(column, 4 * a) = -factors_[p].flux * dot(dP, a, N.begin_raw());
          if (!is_near)
            continue;
          const Matrix3<double> difference = law.linearisation(at_q.F + step * dF)(at_q.misfit_N) -
                                             law.linearisation(at_q.F - step * dF)(at_q.misfit_N);
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int A = 0; A < 3; ++A)
              M(4 * a + 1 + A, column) = -difference(a, A) / (2 * step);
        }
    });
    for (unsigned int a = 0; a < 3; ++a)
      if (!displacement_.is_free(a))
        M(4 * a, 4 * a) = at_q.stiffness;
    return patches_[p].weights[q] * M;
  }

  double Nitsche::energy(const Vector &u, const double t) const
  {
    check_admissible(u);
    double sum = 0;
    for (unsigned int p = 0; p < patches_.size(); ++p)
      for (unsigned int q = 0; q < patches_[p].points.size(); ++q)
      {
        const Terms at_q = terms(p, q, u, t);
        sum += patches_[p].weights[q] * (0.5 * at_q.stiffness * at_q.misfit - at_q.traction) *
               at_q.misfit;
      }
    return dealii::Utilities::MPI::sum(sum, discretization_.communicator());
  }

  Direction Nitsche::total_force(const Vector &u, const double t) const
  {
    Direction total;
    for (unsigned int p = 0; p < patches_.size(); ++p)
      for (unsigned int q = 0; q < patches_[p].points.size(); ++q)
      {
        const Terms at_q = terms(p, q, u, t);
        total += patches_[p].weights[q] * (at_q.traction - at_q.stiffness * at_q.misfit);
      }
    return dealii::Utilities::MPI::sum(total, discretization_.communicator());
  }
} // namespace softcell
