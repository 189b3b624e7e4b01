// SPDX-License-Identifier: LGPL-2.1-or-later
// Nitsche's method.

#include "nitsche_on_a_box.h"
#include "tangent_check.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Region bottom("bottom", "nz < -0.5"), top("top", "nz > 0.5"), all("all", "1");
  } // namespace

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

  // Held close to where it is; farther away a part of the tangent is left out.
  TEST(Nitsche, TangentIsTheDerivativeOfItsResidual)
  {
    const std::string close = "0.1*y*z + 0.002, free, 0.1*sin(x + z) - 0.002*y";
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, all, close);
      EXPECT_LT(tangent_error(body, *support, some_displacement(body), some_direction(body), 1),
                1e-7)
        << model;
    }
  }

  TEST(Nitsche, TangentIsSymmetric)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const auto support = nitsche(body, materials, bottom, "0.1*y, free, 0.02");
    const Vector u = some_displacement(body), v = some_direction(body);
    const BlockMatrix K = tangent_of(body, *support, u, 1);
    Vector Ku = body.make_vector(), Kv = body.make_vector();
    K.vmult(Ku, u);
    K.vmult(Kv, v);
    EXPECT_NEAR(v * Ku, u * Kv, 1e-9 * std::abs(v * Ku));
  }

  // Gradients of degree p - 1 survive the projection, in cells that are cut too. On the face z = 1
  // of u = (z^p, 0, x z^(p-1)) the traction is mu (p + 1) along x and (lambda + 2 mu) (p - 1) x
  // along z.
  TEST(Nitsche, TractionOfAPolynomialIsExact)
  {
    const auto box = make_box(Point(1, 1, 1));
    GridParameters grid;
    grid.cells     = {3};
    grid.scale     = 1.5;
    const double E = 5000, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
    const std::vector<Material> materials{Material("linear", E, nu)};
    for (unsigned int p = 1; p <= 3; ++p)
      for (const std::string rule : {"finite cell", "weighted cell"})
      {
        if (p == 3 && rule == "weighted cell") // has two planes of points in half a cell
          continue;
        const Immersed body(rule, p, grid, {1, 0}, *box, MPI_COMM_WORLD);
        const std::string exponent = "^" + std::to_string(p);
        const auto support =
          nitsche(body, materials, top, "z" + exponent + ", 0, x*z" + exponent + "/z");
        const Vector u = nodal_values(body, [p](const Point &X) {
          return Direction({std::pow(X[2], p), 0, X[0] * std::pow(X[2], p - 1)});
        });
        const Direction expected({mu * (p + 1), 0, (lambda + 2 * mu) * (p - 1) / 2});
        EXPECT_LT((support->total_force(u, 1) - expected).norm(), 1e-9 * expected.norm())
          << rule << ", degree " << p;
      }
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
