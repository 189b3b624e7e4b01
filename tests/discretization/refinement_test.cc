// SPDX-License-Identifier: LGPL-2.1-or-later
// Background grids that are halved where one asks for it.

#include "linear_defect.h"

#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    GridParameters across(const unsigned int n)
    {
      GridParameters parameters;
      parameters.cells = {n};
      return parameters;
    }

    /// Cut cells at the bottom of the unit ball, then a part of them and cells inside.
    const Refinement two_rounds = {{Point(0.1, 0.1, 0.05), Point(-0.1, 0.1, 0.05)},
                                   {Point(0.05, 0.05, 0.02), Point(0.3, 0.3, 0.3)}};

    /// Cut cells whose displacement depends on more nodes than their own eight, or on fewer.
    unsigned int n_hanging_cut_cells(const Immersed &immersed)
    {
      const DrawnCells drawn = immersed.drawn_cells();
      unsigned int n         = 0;
      for (unsigned int c = 0; c < drawn.types.size(); ++c)
      {
        bool hangs = false;
        for (unsigned int k = drawn.offsets[c]; k < drawn.offsets[c + 1]; ++k)
          hangs |= drawn.shapes[drawn.connectivity[k]].nodes.size() > 1;
        n += hangs && drawn.cut_fraction[c] < 1;
      }
      return n;
    }
  } // namespace

  /// Also the nodes: none hangs on the larger cells beside the body.
  TEST(Refinement, OfAllCellsIsTheFinerGrid)
  {
    const auto body = make_sphere(1);
    for (const std::string rule : {"finite cell", "weighted cell", "sparse grid"})
    {
      const Immersed coarse(rule, 2, across(5), {2, 0}, *body, MPI_COMM_SELF);
      Refinement all(1);
      std::vector<Point> points;
      for (unsigned int i = 0; i < coarse.n_patches(); ++i)
      {
        coarse.patch_points(i, points);
        all[0].push_back(points.back());
      }
      const Size halved = Immersed(rule, 2, across(5), {2, 0}, *body, MPI_COMM_WORLD, all).size();
      const Size finer  = Immersed(rule, 2, across(10), {2, 0}, *body, MPI_COMM_WORLD).size();
      EXPECT_EQ(halved.cells, finer.cells) << rule;
      EXPECT_EQ(halved.cut_cells, finer.cut_cells) << rule;
      EXPECT_EQ(halved.unknowns, finer.unknowns) << rule;
    }
  }

  TEST(Refinement, IsTheSameOnAnyNumberOfRanks)
  {
    const auto body = make_sphere(1);
    const auto size = [&](const MPI_Comm communicator) {
      return Immersed("finite cell", 1, across(6), {2, 0}, *body, communicator, two_rounds).size();
    };
    const Size mine = size(MPI_COMM_SELF), ours = size(MPI_COMM_WORLD);
    EXPECT_EQ(mine.cells, ours.cells);
    EXPECT_EQ(mine.unknowns, ours.unknowns);
    EXPECT_EQ(mine.integration_points, ours.integration_points);
  }

  TEST(Refinement, LeavesShapesLinearlyComplete)
  {
    const auto body = make_sphere(1);
    for (const std::string rule : {"finite cell", "weighted cell"})
      for (unsigned int degree = 1; degree <= 2; ++degree)
      {
        const Immersed immersed(rule, degree, across(6), {1, 0}, *body, MPI_COMM_WORLD, two_rounds);
        EXPECT_LT(linear_defect(immersed), 1e-12) << rule << degree;
        const unsigned int n_hanging = n_hanging_cut_cells(immersed);
        EXPECT_GT(dealii::Utilities::MPI::sum(n_hanging, MPI_COMM_WORLD), 0u);
      }
  }

  /// By the divergence theorem the pieces close, whatever the sizes of their cells.
  TEST(Refinement, CutsTheSurfaceOnce)
  {
    const auto body = make_sphere(1);
    const Immersed immersed("finite cell", 1, across(6), {2, 0}, *body, MPI_COMM_WORLD, two_rounds);
    double area = 0, flux = 0;
    Direction normal;
    for (const SurfacePatch &patch : immersed.surface_patches(Region("skin", "1")))
      for (unsigned int q = 0; q < patch.weights.size(); ++q)
      {
        area += patch.weights[q];
        flux += patch.weights[q] * (patch.normals[q] * patch.points[q]);
        normal += patch.weights[q] * patch.normals[q];
        Point X; // where the shapes think the point is
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          X += patch.shapes.value(q)[i] * immersed.node_positions()[patch.nodes[i]];
        EXPECT_LT(X.distance(patch.points[q]), 1e-12);
      }
    const auto sum = [](const auto &value) {
      return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
    };
    EXPECT_NEAR(sum(area), 4 * M_PI, 1e-7);
    EXPECT_NEAR(sum(flux), 4 * M_PI, 1e-7);
    EXPECT_LT(sum(normal).norm(), 1e-7);
  }

  TEST(Refinement, KnowsTheCellOfEachPlace)
  {
    const auto body = make_sphere(1);
    const BackgroundGrid grid(across(6), *body, 1, MPI_COMM_WORLD, two_rounds);
    const Lattice &lattice = grid.lattice();
    EXPECT_EQ(lattice.coarsest_size, 4);
    for (const BackgroundGrid::Cell &cell : grid.cells())
    {
      const Lattice::Cell leaf = lattice.leaf(lattice.index(lattice.box(cell.place).center()));
      EXPECT_EQ(Lattice::key(leaf), Lattice::key(cell.place));
    }
    EXPECT_EQ(lattice.leaf(lattice.index(Point(0.05, 0.05, 0.02))).size, 1);
    EXPECT_EQ(lattice.leaf(lattice.index(Point(-0.1, 0.1, 0.05))).size, 2);
    EXPECT_EQ(lattice.leaf(lattice.index(Point(0.5, 0.5, 1.5))).size, 4);

    double volume   = 0; // of the leaves in a block of 2 x 2 x 2 cells
    const Box block = lattice.box({{{8, 8, 0}}, 8});
    Box inner       = block;
    inner.extend(-1e-6);
    lattice.for_each_leaf(inner,
                          [&](const Lattice::Cell &leaf) { volume += lattice.box(leaf).volume(); });
    EXPECT_NEAR(volume, block.volume(), 1e-12);
  }
} // namespace softcell
