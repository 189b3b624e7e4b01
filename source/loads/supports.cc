// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by forces on the boundary: springs and penalty.

#include <softcell/loads/supports.h>

#include <deal.II/base/mpi.h>

namespace softcell
{
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
    for (SurfacePatch &patch : patches_)
      patch.shapes.drop_gradients();
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
} // namespace softcell
