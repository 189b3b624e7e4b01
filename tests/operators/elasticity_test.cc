// SPDX-License-Identifier: LGPL-2.1-or-later
// Energy, internal force and tangent against each other, against theory, and for any number of
// nodes.

#include <softcell/operators/elasticity.h>

#include "lattice.h"

#include <softcell/base/exceptions.h>
#include <softcell/geometry/shapes.h>
#include <softcell/quadrature/weighted_cell.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace
{
  using namespace softcell;

  const std::vector<std::string> models{"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"};
  constexpr double E = 10, nu = 0.25, mu = 4, lambda = 4;

  Vector displacement(const UnitCells &lattice, const std::function<Point(const Point &)> &deformed)
  {
    Vector u = lattice.make_vector();
    for (unsigned int node = 0; node < lattice.node_positions().size(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
      {
        const Point &X                = lattice.node_positions()[node];
        u.local_element(3 * node + c) = deformed(X)[c] - X[c];
      }
    return u;
  }

  // A smooth deformation without symmetry.
  Point bent(const Point &X)
  {
    return {X[0] + 0.1 * std::sin(X[1]) - 0.05 * X[2] * X[0], 1.1 * X[1] + 0.08 * X[0] * X[0],
            0.95 * X[2] + 0.1 * std::cos(X[0]) * X[1]};
  }

  Vector residual(const Elasticity &elasticity, const Vector &u)
  {
    Vector r(u.get_partitioner());
    elasticity.add_residual(u, r);
    return r;
  }

  dealii::FullMatrix<double>
  tangent(const UnitCells &lattice, const Elasticity &elasticity, const Vector &u)
  {
    BlockMatrix K(lattice.partitioner(), elasticity.couplings());
    elasticity.add_tangent(u, K);
    K.compress();
    dealii::FullMatrix<double> dense(u.size(), u.size());
    Vector x(u.get_partitioner()), y(u.get_partitioner());
    for (unsigned int j = 0; j < u.size(); ++j)
    {
      x    = 0;
      x(j) = 1;
      K.vmult(y, x);
      for (unsigned int i = 0; i < u.size(); ++i)
        dense(i, j) = y(i);
    }
    return dense;
  }

  TEST(Elasticity, ForceAndTangentAreDerivatives)
  {
    const UnitCells lattice({{2, 1, 1}}, 2);
    const double h = 1e-5;
    for (const std::string &model : models)
    {
      const Elasticity elasticity(lattice, {Material(model, E, nu)});
      const Vector u = displacement(lattice, bent);
      const Vector r = residual(elasticity, u);
      const auto K   = tangent(lattice, elasticity, u);
      for (unsigned int j = 0; j < u.size(); ++j)
      {
        Vector up = u, down = u;
        up(j) += h;
        down(j) -= h;
        EXPECT_NEAR(r(j), (elasticity.energy(up) - elasticity.energy(down)) / (2 * h), 1e-7);
        const Vector r_up = residual(elasticity, up), r_down = residual(elasticity, down);
        for (unsigned int i = 0; i < u.size(); ++i)
        {
          EXPECT_NEAR(K(i, j), (r_up(i) - r_down(i)) / (2 * h), 1e-7) << model;
          EXPECT_NEAR(K(i, j), K(j, i), 1e-13);
        }
      }
    }
  }

  // Patches of 8, 12, 18 and 45 nodes: full packs, packs to fill up, several packs.
  TEST(Elasticity, APatchMayHaveAnyNumberOfNodes)
  {
    for (const std::array<unsigned int, 3> &n : std::vector<std::array<unsigned int, 3>>{
           {{1, 1, 1}}, {{2, 1, 1}}, {{2, 2, 1}}, {{4, 2, 2}}})
      for (const std::string &model : models)
      {
        const UnitCells cells(n, 3), merged(n, 3, LatticePatches::merged);
        const Elasticity by_cells(cells, {Material(model, E, nu)});
        const Elasticity at_once(merged, {Material(model, E, nu)});
        const Vector u = displacement(cells, bent);
        EXPECT_NEAR(by_cells.energy(u), at_once.energy(u), 1e-12);
        EXPECT_NEAR(by_cells.min_jacobian(u), at_once.min_jacobian(u), 1e-14);
        Vector r = residual(by_cells, u);
        r -= residual(at_once, u);
        EXPECT_NEAR(r.linfty_norm(), 0, 1e-13);
        auto K = tangent(cells, by_cells, u);
        K.add(-1, tangent(merged, at_once, u));
        EXPECT_NEAR(K.linfty_norm(), 0, 1e-12);
      }
  }

  TEST(Elasticity, ARotatedBodyIsFreeOfForce)
  {
    const UnitCells lattice({{2, 2, 2}}, 2);
    const Vector u = displacement(lattice, [](const Point &X) {
      return Point(0.6 * X[0] - 0.8 * X[1], X[2] + 3, -0.8 * X[0] - 0.6 * X[1]);
    });
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
    {
      const Elasticity elasticity(lattice, {Material(model, E, nu)});
      EXPECT_NEAR(residual(elasticity, u).linfty_norm(), 0, 1e-13);
      EXPECT_NEAR(elasticity.energy(u), 0, 1e-13);
      EXPECT_NEAR(elasticity.min_jacobian(u), 1, 1e-14);
    }
  }

  // Stretched by k along x, a Neo-Hookean block pulls with P_11 = mu (k - 1/k) + lambda ln k / k on
  // its ends.
  TEST(Elasticity, UniformStretchPullsWithStressTimesArea)
  {
    const double k = 1.5;
    const UnitCells lattice({{3, 2, 2}}, 2);
    const Elasticity elasticity(lattice, {Material("Neo-Hookean", E, nu)});
    const Vector u =
      displacement(lattice, [&](const Point &X) { return Point(k * X[0], X[1], X[2]); });
    const Vector r = residual(elasticity, u);
    double force   = 0;
    for (unsigned int node = 0; node < lattice.node_positions().size(); ++node)
      if (lattice.node_positions()[node][0] == 3)
        force += r(3 * node);
    EXPECT_NEAR(force, 4 * (mu * (k - 1 / k) + lambda * std::log(k) / k), 1e-12);
    EXPECT_NEAR(elasticity.energy(u),
                12 *
                  (mu / 2 * (k * k - 1) - mu * std::log(k) + lambda / 2 * std::pow(std::log(k), 2)),
                1e-12);
    EXPECT_NEAR(elasticity.volume(), 12, 1e-13);

    // sigma_11 = P_11 and sigma_22 = sigma_33 = P_22 / k, so the von Mises stress is their
    // difference.
    const PatchAverages averages = elasticity.averages(u);
    for (unsigned int i = 0; i < lattice.n_patches(); ++i)
    {
      EXPECT_NEAR(averages.jacobian[i], k, 1e-14);
      EXPECT_NEAR(averages.von_mises[i], mu * (k - 1 / k), 1e-13);
    }
  }

  TEST(Elasticity, EachPointFollowsTheMaterialOfItsLabel)
  {
    UnitCells lattice({{2, 1, 1}}, 2);
    // The second cell's lower half is of the stiff material, twice with the points in another
    // order.
    lattice.cells[1].labels = {1, 1, 1, 1, 0, 0, 0, 0};
    const Vector u =
      displacement(lattice, [](const Point &X) { return Point(X[0], X[1], X[2] * 1.2); });
    const Elasticity soft(lattice, {Material("linear", E, nu), Material("linear", E, nu)});
    const Elasticity both(lattice, {Material("linear", E, nu), Material("linear", 3 * E, nu)});
    EXPECT_NEAR(both.energy(u), soft.energy(u) * (0.75 + 3 * 0.25), 1e-13);
  }

  // A cell of which an octant, or two beside each other, is filled. A point has six strains; of
  // those of two points along x, the one along x is the same, as it is constant along x.
  TEST(Elasticity, ASpreadWeightedCellHasNoMotionWithoutForceButRigidOnes)
  {
    const auto n_without_force = [](const unsigned int n_octants, const double spread) {
      const auto body = make_box(Point(0.5 * n_octants, 0.5, 0.5));
      WeightedCell rule({1, 0, spread}, 1, *body);
      rule.add(Box({Point(), Point(1, 1, 1)}));
      CutPoints points;
      rule.points(0, points);
      UnitCells lattice({{1, 1, 1}}, 2);
      lattice.cells[0].weights = points.weights;
      const Elasticity elasticity(lattice, {Material("Neo-Hookean", E, nu)});
      dealii::LAPACKFullMatrix<double> K(24);
      K = tangent(lattice, elasticity, lattice.make_vector());
      K.compute_eigenvalues();
      unsigned int n = 0;
      for (unsigned int i = 0; i < 24; ++i)
        n += std::abs(K.eigenvalue(i)) < 1e-12 * E;
      return n;
    };
    EXPECT_EQ(n_without_force(1, 0), 24u - 6);
    EXPECT_EQ(n_without_force(2, 0), 24u - 11);
    for (const unsigned int n_octants : {1, 2})
      EXPECT_EQ(n_without_force(n_octants, CutParameters().spread), 6u);
  }

  TEST(Elasticity, AnInvertedPointIsReportedUnlessItHasNoWeight)
  {
    UnitCells lattice({{2, 1, 1}}, 2);
    const Vector inverted = displacement(
      lattice, [](const Point &X) { return Point(X[0] == 2 ? 0.5 : X[0], X[1], X[2]); });
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
    {
      const Elasticity elasticity(lattice, {Material(model, E, nu)});
      Vector r = lattice.make_vector();
      BlockMatrix K(lattice.partitioner(), elasticity.couplings());
      EXPECT_THROW(elasticity.energy(inverted), InvertedPoint);
      EXPECT_THROW(elasticity.add_residual(inverted, r), InvertedPoint);
      EXPECT_THROW(elasticity.add_tangent(inverted, K), InvertedPoint);
      EXPECT_NEAR(elasticity.min_jacobian(inverted), -0.5, 1e-14);
    }
    EXPECT_NO_THROW(Elasticity(lattice, {Material("linear", E, nu)}).energy(inverted));

    lattice.cells[1].weights.assign(8, 0.);
    const Elasticity elasticity(lattice, {Material("Neo-Hookean", E, nu)});
    EXPECT_NEAR(elasticity.energy(inverted), 0, 1e-15);
    EXPECT_NEAR(elasticity.min_jacobian(inverted), 1, 1e-15);
  }
} // namespace
