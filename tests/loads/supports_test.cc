// SPDX-License-Identifier: LGPL-2.1-or-later
// Springs, penalty and Nitsche's method.

#include "tangent_check.h"

#include <softcell/base/exceptions.h>
#include <softcell/loads/supports.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Region bottom("bottom", "nz < -0.5"), all("all", "1");

    std::unique_ptr<Nitsche> nitsche(const BoxOfCells &body,
                                     const std::vector<Material> &materials,
                                     const Region &region,
                                     const std::string &displacement)
    {
      return std::make_unique<Nitsche>(body, body.surface_patches(region),
                                       Expression(displacement, 3, ""), materials, 10,
                                       region.name());
    }

    /// Adds int P : grad N, the internal force.
    void
    add_internal_force(const BoxOfCells &body, const Material &material, const Vector &u, Vector &r)
    {
      PatchStorage storage;
      for (unsigned int p = 0; p < body.n_patches(); ++p)
      {
        const Patch patch = body.patch(p, storage);
        for (unsigned int q = 0; q < 8; ++q)
        {
          const double *const G = patch.shapes->gradient(q);
          const Gradient H      = interpolate_gradient(patch.nodes, G, u);
          Matrix3<double> F     = identity<double>();
          for (unsigned int a = 0; a < 9; ++a)
            F.entries[a] += H[a / 3][a % 3];
          const Matrix3<double> P =
            material.visit([&](const auto &law) { return law.first_piola_stress(F); });
          for (unsigned int i = 0; i < 8; ++i)
            for (unsigned int a = 0; a < 3; ++a)
              for (unsigned int d = 0; d < 3; ++d)
                r.local_element(3 * patch.nodes[i] + a) +=
                  patch.weights[q] * P(a, d) * G[d * 8 + i];
        }
      }
      r.compress(dealii::VectorOperation::add);
    }
  } // namespace

  TEST(Penalty, PullsByStiffnessTimesMisfit)
  {
    const BoxOfCells body({2, 2, 3}, Point(2, 1, 1), MPI_COMM_WORLD);
    const Penalty penalty(body, body.surface_patches(bottom), Expression("0.1, free, 0", 3, ""),
                          Expression("1000*x", 1, ""), "bottom");
    const Vector u = nodal_values(body, [](const Point &) { return Direction({0.3, 5, 0.2}); });
    // int 1000 x dA = 2000; at t = 1/2 the misfit is (0.25, -, 0.2).
    EXPECT_LT((penalty.total_force(u, 0.5) - Direction({-500, 0, -400})).norm(), 1e-9);
    EXPECT_NEAR(penalty.energy(u, 0.5), 0.5 * 2000 * (0.0625 + 0.04), 1e-9);
    const Vector v = some_direction(body);
    EXPECT_LT(energy_error(body, penalty, some_displacement(body), v, 0.5), 1e-8);
    EXPECT_LT(tangent_error(body, penalty, u, v, 0.5), 1e-8);
  }

  TEST(Nitsche, ResidualIsTheDerivativeOfItsPotential)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, bottom, "0.1*y, free, 0.02");
      EXPECT_LT(energy_error(body, *support, some_displacement(body), some_direction(body), 0.8),
                1e-7)
        << model;
    }
  }

  TEST(Nitsche, TangentIsTheDerivativeForTheLinearLaw)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("linear", 5000, 0.3)};
    const auto support = nitsche(body, materials, bottom, "0.1*y, free, 0.02");
    EXPECT_LT(tangent_error(body, *support, some_displacement(body), some_direction(body), 0.8),
              1e-7);
  }

  TEST(Nitsche, TangentIsTheDerivativeWhereNothingIsMisplaced)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const auto support = nitsche(body, materials, all, "0.1*y, 0.2*z - 0.1*x, 0.3*z");
    const Vector u     = nodal_values(body, [](const Point &X) {
      return Direction({0.1 * X[1], 0.2 * X[2] - 0.1 * X[0], 0.3 * X[2]});
    });
    EXPECT_LT(tangent_error(body, *support, u, some_direction(body), 1), 1e-7);
  }

  // The exact solution satisfies the discrete equations: a linear displacement imposed all around.
  TEST(Nitsche, PassesThePatchTest)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, all, "0.1*y, 0.2*z - 0.1*x, 0.3*z");
      const Vector u     = nodal_values(body, [](const Point &X) {
        return Direction({0.1 * X[1], 0.2 * X[2] - 0.1 * X[0], 0.3 * X[2]});
      });
      Vector r           = body.make_vector();
      add_internal_force(body, materials[0], u, r);
      const double scale = r.linfty_norm();
      EXPECT_GT(scale, 10.);
      r += residual_of(body, *support, u, 1);
      EXPECT_LT(r.linfty_norm(), 1e-12 * scale) << model;
    }
  }

  TEST(Nitsche, ReportsAnInvertedSurfaceOnAllRanks)
  {
    const BoxOfCells body({1, 1, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const auto support = nitsche(body, materials, bottom, "0, 0, 0");
    const Vector u     = nodal_values(body, [](const Point &X) {
      return Direction({0, 0, X[2] < 0.1 ? 0.5 : 0.});
    });
    Vector r           = body.make_vector();
    EXPECT_THROW(support->add_residual(u, 1, r), InvertedPoint);
  }
} // namespace softcell
