// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cut cells, against formulas for a cube that fills half of each cut cell's edges.

#include <softcell/operators/stabilization.h>

#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/operators/elasticity.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace softcell
{
  namespace
  {
    constexpr double E = 10, nu = 0.25, mu = 4, lambda = 4, alpha = 1e-3;

    /// A cube of 1 m in 3 x 3 x 3 cells of 0.5 m, of which the outer ones stand out by half.
    struct CutCube
    {
      explicit CutCube(const CutParameters &cut)
          : immersed("finite cell", 1, grid(), cut, *body, MPI_COMM_WORLD)
      {
      }

      static GridParameters grid()
      {
        GridParameters parameters;
        parameters.cells   = {3};
        parameters.padding = 0.25;
        return parameters;
      }

      Vector displacement(const std::function<Direction(const Point &)> &u) const
      {
        Vector result = immersed.make_vector();
        for (unsigned int node = 0; node < immersed.node_positions().size(); ++node)
          for (unsigned int c = 0; c < 3; ++c)
            result.local_element(3 * node + c) = u(immersed.node_positions()[node])[c];
        return result;
      }

      Vector force(const Stabilization &stabilization, const Vector &u) const
      {
        Vector r = immersed.make_vector();
        stabilization.add_residual(u, r);
        r.compress(dealii::VectorOperation::add);
        return r;
      }

      std::unique_ptr<Body> body = make_box(Point(1, 1, 1));
      Immersed immersed;
      std::vector<Material> materials = {Material("Neo-Hookean", E, nu)};
    };

    const CutParameters soft_outside = {1, alpha};

    Direction crumpled(const Point &X)
    {
      return Direction({std::sin(7 * X[0] + X[1]), std::cos(5 * X[2]) * X[0], X[1] * X[1] * X[2]});
    }
  } // namespace

  TEST(Stabilization, FictitiousPartHasTheLinearEnergyOfWhatIsEmpty)
  {
    const CutCube cube(soft_outside);
    const Stabilization stabilization(cube.immersed, cube.materials);
    // strains 0.2, -0.1, 0 along the axes and 0.05 of shear between x and y; and a rotation
    const Vector u       = cube.displacement([](const Point &X) {
      return Direction({0.2 * X[0] + 0.3 * X[1], -0.2 * X[0] - 0.1 * X[1], 7.});
    });
    const double density = lambda / 2 * 0.1 * 0.1 + mu * (0.2 * 0.2 + 0.1 * 0.1 + 2 * 0.05 * 0.05);
    const double empty   = std::pow(1.5, 3) - 1;
    EXPECT_NEAR(stabilization.energy(u), alpha * empty * density, 1e-15);
    EXPECT_NEAR(Elasticity(cube.immersed, cube.materials).volume(), 1, 1e-13);
  }

  TEST(Stabilization, ForceAndTangentAreDerivativesOfTheEnergy)
  {
    const CutCube cube(soft_outside);
    const Stabilization stabilization(cube.immersed, cube.materials);
    const Elasticity elasticity(cube.immersed, cube.materials);
    BlockMatrix K(cube.immersed.partitioner(), elasticity.couplings());
    stabilization.add_tangent(K);
    K.compress();

    // of a quadratic energy, exactly: 2 E(u) = r . u and r = K u
    const Vector u = cube.displacement(crumpled), r = cube.force(stabilization, u);
    EXPECT_GT(stabilization.energy(u), 0.01 * alpha);
    EXPECT_NEAR(r * u, 2 * stabilization.energy(u), 1e-12 * alpha);
    Vector Ku = cube.immersed.make_vector();
    K.vmult(Ku, u);
    Ku -= r;
    EXPECT_LT(Ku.linfty_norm(), 1e-12 * r.linfty_norm());
  }

  /// A node far out is pushed in by 0.5 m along all axes: where the body is J is 1 - (xy + yz + zx)
  /// with x, y, z < 0.4 of the cell, at its outer Gauss point 1 - 3 * 0.79^2.
  TEST(Stabilization, WhatIsOutsideMayTurnInsideOut)
  {
    const CutCube cube(soft_outside);
    const Vector u = cube.displacement([](const Point &X) {
      const bool is_corner = X.distance(Point(1.25, 1.25, 1.25)) < 1e-9;
      return is_corner ? Direction({-0.5, -0.5, -0.5}) : Direction();
    });
    const Elasticity elasticity(cube.immersed, cube.materials);
    EXPECT_NO_THROW(elasticity.energy(u));
    EXPECT_GT(elasticity.min_jacobian(u), 0.5);
    const Stabilization stabilization(cube.immersed, cube.materials);
    EXPECT_GT(stabilization.energy(u), alpha * E / 100);
    EXPECT_TRUE(std::isfinite(cube.force(stabilization, u).l2_norm()));
  }

  TEST(Stabilization, IsNothingByDefault)
  {
    const CutCube cube({1});
    const Stabilization stabilization(cube.immersed, cube.materials);
    EXPECT_EQ(stabilization.energy(cube.displacement(crumpled)), 0);
  }
} // namespace softcell
