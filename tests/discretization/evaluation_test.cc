// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements at points of any rank.

#include "../box_of_cells.h"

#include <softcell/discretization/evaluation.h>
#include <softcell/discretization/fitted.h>
#include <softcell/discretization/hexahedral_mesh.h>
#include <softcell/discretization/immersed.h>
#include <softcell/discretization/tetrahedral_mesh.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    /// A field that trilinear shapes hold exactly, and its gradient.
    Direction field(const Point &X)
    {
      return Direction({1 + 2 * X[0] * X[1] * X[2], X[1] - X[0] * X[2], 3 * X[2]});
    }
    Gradient field_gradient(const Point &X)
    {
      Gradient g;
      g[0] = Direction({2 * X[1] * X[2], 2 * X[0] * X[2], 2 * X[0] * X[1]});
      g[1] = Direction({-X[2], 1, -X[0]});
      g[2] = Direction({0, 0, 3});
      return g;
    }
  } // namespace

  TEST(Evaluation, AnswersWhereverThePointLies)
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const BoxOfCells lattice({2, 3, 7}, Point(1, 2, 3), MPI_COMM_WORLD);
    const Vector u = nodal_values(lattice, field);
    std::vector<Point> points; // every rank asks for other points; the first ones lie between cells
    if (rank != 1)
      for (unsigned int k = 0; k <= 40 + rank; ++k)
        points.emplace_back(k / (40. + rank), 2 - k / (20. + rank), 3 * (k % 8) / 7.);
    const PointValues values = evaluate(lattice, u, points, 0);
    ASSERT_EQ(values.displacements.size(), points.size());
    for (unsigned int k = 0; k < points.size(); ++k)
    {
      EXPECT_EQ(values.distances[k], 0) << points[k];
      EXPECT_LT((values.displacements[k] - field(points[k])).norm(), 1e-13) << points[k];
      EXPECT_LT((values.gradients[k] - field_gradient(points[k])).norm(), 1e-12) << points[k];
    }
  }

  // The displacement has a kink in every face, and all points lie on faces, in edges, in corners or
  // beyond a symmetry plane of the outer cells.
  TEST(Evaluation, TakesTheSameCellOnAnyNumberOfRanks)
  {
    const std::array<unsigned int, 3> n = {{4, 4, 4}};
    const Point size(1, 1, 1);
    const auto body     = make_box(size);
    const auto immersed = [&](MPI_Comm communicator) {
      GridParameters grid;
      grid.cells = {4};
      return std::make_unique<Immersed>("finite cell", 1, grid, CutParameters(), *body,
                                        communicator);
    };
    const auto fitted = [&](const Mesh &mesh) {
      return [&body, mesh](MPI_Comm communicator) {
        return std::make_unique<Fitted>(communicator, mesh, 1, *body);
      };
    };
    const auto check = [](const auto &make) {
      const auto kinks = [](const Point &X) {
        return Direction(
          {std::sin(9 * X[0] + 2 * X[1]), std::cos(8 * X[1] * X[2]), 3 * X[2] * X[0]});
      };
      const auto shared = make(MPI_COMM_WORLD), alone = make(MPI_COMM_SELF);
      std::vector<Point> points;
      for (unsigned int i = 0; i < 11 * 9 * 9; ++i)
        points.emplace_back((i % 11 - 1.) / 8, i / 11 % 9 / 8., i / 99 / 8.);
      const PointValues some = evaluate(*shared, nodal_values(*shared, kinks), points, 0.5),
                        all  = evaluate(*alone, nodal_values(*alone, kinks), points, 0.5);
      for (unsigned int i = 0; i < points.size(); ++i)
      {
        EXPECT_NEAR(some.distances[i], all.distances[i], 1e-14) << points[i];
        EXPECT_LT((some.gradients[i] - all.gradients[i]).norm(), 1e-10) << points[i];
      }
    };
    check(immersed);
    check(fitted(hexahedral_box(size, n)));
    check(fitted(kuhn_box(size, n)));
  }

  TEST(Evaluation, ExtendsTheNearestCellWithinReach)
  {
    const BoxOfCells lattice({2, 2, 5}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Vector u = nodal_values(lattice, field);
    const std::vector<Point> points{Point(0.3, 0.4, 1.1), Point(-0.2, 0.5, 0.9), Point(0, 0, -0.3)};
    const PointValues near = evaluate(lattice, u, points, 0.25);
    EXPECT_NEAR(near.distances[0], 0.1, 1e-14);
    EXPECT_NEAR(near.distances[1], 0.2, 1e-14);
    for (const unsigned int k : {0, 1}) // the field is one polynomial in all cells
      EXPECT_LT((near.displacements[k] - field(points[k])).norm(), 1e-13);
    EXPECT_TRUE(std::isinf(near.distances[2]));
    EXPECT_EQ(near.displacements[2].norm(), 0);
  }
} // namespace softcell
