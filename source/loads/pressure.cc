// SPDX-License-Identifier: LGPL-2.1-or-later
// A pressure that follows the surface.

#include <softcell/loads/pressure.h>

#include <softcell/discretization/evaluation.h>

#include <deal.II/base/mpi.h>

#include <array>

namespace softcell
{
  namespace
  {
    /// Unit tangents with t_1 x t_2 = N.
    std::array<Direction, 2> tangents(const Direction &N)
    {
      Direction axis; // the one least along N
      unsigned int smallest = 0;
      for (unsigned int c = 1; c < 3; ++c)
        if (std::abs(N[c]) < std::abs(N[smallest]))
          smallest = c;
      axis[smallest]  = 1;
      Direction first = dealii::cross_product_3d(N, axis);
      first /= first.norm();
      return {{first, dealii::cross_product_3d(N, first)}};
    }

    /// F t_1 and F t_2 at a point.
    std::array<Direction, 2>
    deformed_tangents(const SurfacePatch &patch, const unsigned int q, const Vector &u)
    {
      const Gradient gradient    = interpolate_gradient(patch.nodes, patch.shapes.gradient(q), u);
      std::array<Direction, 2> a = tangents(patch.normals[q]);
      for (Direction &tangent : a)
        tangent += gradient * tangent;
      return a;
    }
  } // namespace

  Pressure::Pressure(const Discretization &discretization,
                     std::vector<SurfacePatch> patches,
                     Expression pressure,
                     std::string region)
      : discretization_(discretization),
        patches_(std::move(patches)),
        pressure_(std::move(pressure)),
        region_(std::move(region))
  {
  }

  void Pressure::add_residual(const Vector &u, const double t, Vector &r) const
  {
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const auto [a_1, a_2]   = deformed_tangents(patch, q, u);
        const double p          = pressure_.at_load_factor(patch.points[q], t)[0];
        const Direction minus_f = p * patch.weights[q] * dealii::cross_product_3d(a_1, a_2);
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            r.local_element(3 * patch.nodes[i] + c) += minus_f[c] * patch.shapes.value(q)[i];
      }
  }

  // With u_j along axis b growing, d(a_1 x a_2) = e_b x c_j, c_j = (t_1 . G_j) a_2 - (t_2 . G_j)
  // a_1, where G_j = dN_j/dX. So K_iajb = p w N_i (e_b x c_j)_a.
  void Pressure::add_tangent(const Vector &u, const double t, BlockMatrix &K) const
  {
    std::vector<double> values;
    std::vector<Direction> c;
    for (const SurfacePatch &patch : patches_)
    {
      const unsigned int n = patch.nodes.size();
      values.assign(9 * n * n, 0.);
      c.resize(n);
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const auto [t_1, t_2] = tangents(patch.normals[q]);
        const auto [a_1, a_2] = deformed_tangents(patch, q, u);
        const double *const N = patch.shapes.value(q);
        const double *const G = patch.shapes.gradient(q);
        const double p_weight = patch.weights[q] * pressure_.at_load_factor(patch.points[q], t)[0];
        for (unsigned int j = 0; j < n; ++j)
        {
          const Direction G_j({G[j], G[n + j], G[2 * n + j]});
          c[j] = (t_1 * G_j) * a_2 - (t_2 * G_j) * a_1;
        }
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b < 3; ++b)
          {
            if (a == b)
              continue;
            const unsigned int k = 3 - a - b;
            const double sign    = (b + 1) % 3 == k ? 1 : -1; // of (e_b x e_k)_a
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                values[((a * n + i) * 3 + b) * n + j] += sign * p_weight * N[i] * c[j][k];
          }
      }
      K.add(patch.nodes, values.data());
    }
  }

  void Pressure::add_couplings(std::vector<std::vector<unsigned int>> &couplings) const
  {
    for (const SurfacePatch &patch : patches_)
      couplings.push_back(patch.nodes);
  }

  Direction Pressure::total_force(const Vector &u, const double t) const
  {
    Direction total;
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        const auto [a_1, a_2] = deformed_tangents(patch, q, u);
        const double p        = pressure_.at_load_factor(patch.points[q], t)[0];
        total -= p * patch.weights[q] * dealii::cross_product_3d(a_1, a_2);
      }
    return dealii::Utilities::MPI::sum(total, discretization_.communicator());
  }
} // namespace softcell
