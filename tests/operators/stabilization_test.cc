// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cut cells, against formulas for a cube that fills half of each cut cell's edges.

#include <softcell/operators/stabilization.h>

#include "../box_of_cells.h"

#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/operators/elasticity.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace softcell
{
  namespace
  {
    constexpr double E = 10, nu = 0.25, mu = 4, lambda = 4, alpha = 1e-3;

    /// A cube of 1 m in 3 x 3 x 3 cells of 0.5 m, of which the outer ones stand out by half.
    struct CutCube
    {
      explicit CutCube(const CutParameters &cut,
                       const double padding         = 0.25,
                       const Refinement &refinement = {})
          : immersed("finite cell", 1, grid(padding), cut, *body, MPI_COMM_WORLD, refinement)
      {
      }

      static GridParameters grid(const double padding)
      {
        GridParameters parameters;
        parameters.cells   = {3};
        parameters.padding = padding;
        return parameters;
      }

      Vector displacement(const std::function<Direction(const Point &)> &u) const
      {
        return nodal_values(immersed, u);
      }

      Vector force(const Stabilization &stabilization, const Vector &u) const
      {
        Vector r = immersed.make_vector();
        stabilization.add_residual(u, r);
        r.compress(dealii::VectorOperation::add);
        return r;
      }

      BlockMatrix matrix(const Stabilization &stabilization) const
      {
        auto couplings = Elasticity(immersed, materials).couplings();
        stabilization.add_couplings(couplings);
        return {immersed.partitioner(), couplings};
      }

      std::unique_ptr<Body> body = make_box(Point(1, 1, 1));
      Immersed immersed;
      std::vector<Material> materials = {Material("Neo-Hookean", E, nu)};
    };

    const CutParameters soft_outside  = {1, alpha};
    const CutParameters ghost_penalty = {1, 0, 0, 0.1};
    const Material nearly_incompressible("Neo-Hookean", 8 * 1.499, 0.499); // mu = 4

    /// Ratio of the largest eigenvalue to the smallest but `n_zero`; it gathers the matrix.
    double spectral_condition(const BlockMatrix &K, const unsigned int n_zero)
    {
      const unsigned int n = K.partitioner()->size();
      dealii::LAPACKFullMatrix<double> dense(n);
      Vector x(K.partitioner()), y(x);
      for (unsigned int j = 0; j < n; ++j)
      {
        x = 0;
        if (x.in_local_range(j))
          x(j) = 1;
        K.vmult(y, x);
        for (unsigned int i = 0; i < n; ++i)
          dense(i, j) =
            dealii::Utilities::MPI::sum(y.in_local_range(i) ? y(i) : 0., MPI_COMM_WORLD);
      }
      dense.compute_eigenvalues();
      std::vector<double> eigenvalues;
      for (unsigned int i = 0; i < n; ++i)
        eigenvalues.push_back(dense.eigenvalue(i).real());
      std::sort(eigenvalues.begin(), eigenvalues.end());
      EXPECT_GT(eigenvalues.front(), -1e-12 * eigenvalues.back());
      return eigenvalues.back() / eigenvalues[n_zero];
    }

    Direction crumpled(const Point &X)
    {
      return Direction({std::sin(7 * X[0] + X[1]), std::cos(5 * X[2]) * X[0], X[1] * X[1] * X[2]});
    }
  } // namespace

  /// Nearly incompressible (mu = 4 again), with lambda = 2 mu.
  TEST(Stabilization, FictitiousPartHasTheLinearEnergyOfWhatIsEmpty)
  {
    const CutCube cube(soft_outside);
    // strains 0.2, -0.1, 0 along the axes and 0.05 of shear between x and y; and a rotation
    const Vector u     = cube.displacement([](const Point &X) {
      return Direction({0.2 * X[0] + 0.3 * X[1], -0.2 * X[0] - 0.1 * X[1], 7.});
    });
    const double shear = mu * (0.2 * 0.2 + 0.1 * 0.1 + 2 * 0.05 * 0.05);
    const double empty = std::pow(1.5, 3) - 1;
    for (const auto &[material, limited] :
         {std::pair(cube.materials[0], lambda), std::pair(nearly_incompressible, 2 * mu)})
    {
      const Stabilization stabilization(cube.immersed, {material});
      EXPECT_NEAR(stabilization.energy(u), alpha * empty * (limited / 2 * 0.1 * 0.1 + shear),
                  1e-15);
    }
    EXPECT_NEAR(Elasticity(cube.immersed, cube.materials).volume(), 1, 1e-13);
  }

  TEST(Stabilization, ForceAndTangentAreDerivativesOfTheEnergy)
  {
    for (const CutParameters &cut : {soft_outside, ghost_penalty})
    {
      const CutCube cube(cut);
      const Stabilization stabilization(cube.immersed, cube.materials);
      BlockMatrix K = cube.matrix(stabilization);
      stabilization.add_tangent(K);
      K.compress();

      // of a quadratic energy, exactly: 2 E(u) = r . u and r = K u
      const Vector u = cube.displacement(crumpled), r = cube.force(stabilization, u);
      EXPECT_GT(stabilization.energy(u), 0.01 * alpha);
      EXPECT_NEAR(r * u, 2 * stabilization.energy(u), 1e-12 * (r * u));
      Vector Ku = cube.immersed.make_vector();
      K.vmult(Ku, u);
      Ku -= r;
      EXPECT_LT(Ku.linfty_norm(), 1e-12 * r.linfty_norm());
    }
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

  /// A kink of 1 in the plane x = 0.25, between nine pairs of cells of which one at least is cut.
  /// Nearly incompressible, it does not grow with lambda. With all cells on the right halved, each
  /// of 16 small faces has a box of (h/2)^3 and a quarter of one of h^3: the mean of both sizes.
  TEST(Stabilization, GhostPenaltyIsThatOfBurmanForTrilinearCells)
  {
    Refinement right(1);
    for (const double y : {0., 0.5, 1.})
      for (const double z : {0., 0.5, 1.})
        right[0].insert(right[0].end(), {Point(0.5, y, z), Point(1, y, z)});
    for (const auto &[refinement, h, area] :
         {std::tuple(Refinement(), 0.5, 9 * 0.5 * 0.5), std::tuple(right, 0.375, 1.)})
    {
      const CutCube cube(ghost_penalty, 0.25, refinement);
      const Vector u = cube.displacement([](const Point &X) {
        return Direction({std::max(X[0] - 0.25, 0.), 0., 0.});
      });
      for (const auto &[material, M] : {std::pair(cube.materials[0], lambda + 2 * mu),
                                        std::pair(nearly_incompressible, 4 * mu)})
        EXPECT_NEAR(Stabilization(cube.immersed, {material}).energy(u),
                    M / 2 * 0.1 * 2. / 3 * h * area, 1e-14);
    }
  }

  /// With hanging nodes too, of cells beside those that are cut and of cut ones.
  TEST(Stabilization, GhostPenaltyLeavesPolynomialsAlone)
  {
    const auto body           = make_sphere(0.5);
    const Refinement at_cut[] = {{}, {}, {{Point(0.05, 0.05, 0.02), Point(0.3, 0.3, 0.3)}}};
    const std::vector<Material> materials = {Material("Neo-Hookean", E, nu)};
    for (unsigned int degree = 1; degree <= 2; ++degree)
      for (unsigned int kind = 0; kind < 3; ++kind)
      {
        GridParameters grid;
        grid.cells              = {kind == 0 ? 8u : 4u};
        grid.surface_refinement = kind == 1 ? 1 : 0;
        const Immersed immersed("weighted cell", degree, grid, ghost_penalty, *body, MPI_COMM_WORLD,
                                at_cut[kind]);
        const Stabilization stabilization(immersed, materials);
        const auto energy = [&](const unsigned int power) {
          return stabilization.energy(nodal_values(immersed, [&](const Point &X) {
            return Direction({0., std::pow(X[0] + 0.5 * X[1] - X[2], power), 0.});
          }));
        };
        EXPECT_LT(energy(degree), 1e-13);
        EXPECT_GT(energy(degree + 1), 1e-6);
      }
  }

  /// The largest and the smallest eigenvalue but those of the six rigid motions, of a cube all but
  /// whose middle cell is hardly cut. The octree sees a cut that holds a Gauss point of a leaf.
  TEST(Stabilization, GhostPenaltyBoundsTheConditionHoweverCellsAreCut)
  {
    const auto condition = [](const unsigned int levels, const double gamma) {
      const double filled = 0.25 * std::pow(0.5, levels); // of a cell along one axis
      const CutCube cube({levels, 0, 0, gamma}, (1 - filled) / (1 + 2 * filled));
      const Stabilization stabilization(cube.immersed, cube.materials);
      const Elasticity elasticity(cube.immersed, cube.materials);
      BlockMatrix K = cube.matrix(stabilization);
      elasticity.add_tangent(cube.immersed.make_vector(), K);
      stabilization.add_tangent(K);
      K.compress();
      return spectral_condition(K, 6);
    };
    const double well = condition(1, 0.1);
    EXPECT_LT(condition(5, 0.1), 10 * well);
    EXPECT_GT(condition(5, 0), 1e9 * well); // smallest cut 8^-6
  }

  TEST(Stabilization, IsNothingByDefault)
  {
    const CutCube cube({1});
    const Stabilization stabilization(cube.immersed, cube.materials);
    EXPECT_EQ(stabilization.energy(cube.displacement(crumpled)), 0);
  }
} // namespace softcell
