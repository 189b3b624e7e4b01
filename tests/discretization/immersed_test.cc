// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts, nodes and shapes of immersed discretizations.

#include "../box_surface.h"
#include "linear_defect.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/geometry/surface_body.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace softcell
{
  namespace
  {
    GridParameters cells_across(const unsigned int n, const unsigned int refinement = 0)
    {
      GridParameters parameters;
      parameters.cells              = {n};
      parameters.surface_refinement = refinement;
      return parameters;
    }

    double seen_volume(const Immersed &immersed)
    {
      PatchStorage storage;
      double volume = 0;
      for (unsigned int i = 0; i < immersed.n_patches(); ++i)
        for (const double w : immersed.patch(i, storage).weights)
          volume += w;
      return dealii::Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    }
    /// (3, n_nodes) Units: m^2
    std::vector<double> integrated_gradients(const Patch &patch)
    {
      std::vector<double> result(3 * patch.n_nodes());
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        for (unsigned int i = 0; i < result.size(); ++i)
          result[i] += patch.weights[q] * patch.shapes->gradient(q)[i];
      return result;
    }
  } // namespace

  TEST(Immersed, CountsOfABoxAreThoseOfItsGrid)
  {
    const auto body = make_box(Point(1, 2, 1.5));
    for (unsigned int degree = 1; degree <= 3; ++degree)
    {
      const Immersed immersed("finite cell", degree, cells_across(2), {3, 0}, *body,
                              MPI_COMM_WORLD);
      const Size size = immersed.size();
      EXPECT_EQ(size.cells, 2u * 4 * 3);
      EXPECT_EQ(size.cut_cells, 0u);
      EXPECT_EQ(size.unknowns, 3 * (2 * degree + 1) * (4 * degree + 1) * (3 * degree + 1));
      EXPECT_EQ(size.integration_points, 24 * std::pow(degree + 1, 3));
      EXPECT_NEAR(seen_volume(immersed), 3, 1e-13);
    }
  }

  TEST(Immersed, EveryNodeHasOneOwnerAndAnActiveCell)
  {
    const auto body = make_sphere(1);
    const Immersed immersed("weighted cell", 2, cells_across(7), {2, 0}, *body, MPI_COMM_WORLD);
    // the nodes counted a second way: all distinct positions of all ranks' patches
    std::set<std::array<long, 3>> positions;
    PatchStorage storage;
    for (unsigned int i = 0; i < immersed.n_patches(); ++i)
      for (const unsigned int node : immersed.patch(i, storage).nodes)
      {
        const Point X = immersed.node_positions()[node];
        positions.insert({{std::lround(X[0] * 7), std::lround(X[1] * 7), std::lround(X[2] * 7)}});
      }
    EXPECT_EQ(positions.size(), immersed.node_positions().size());
    std::set<std::array<long, 3>> all;
    for (const auto &some : dealii::Utilities::MPI::all_gather(
           MPI_COMM_WORLD, std::vector<std::array<long, 3>>(positions.begin(), positions.end())))
      all.insert(some.begin(), some.end());
    EXPECT_EQ(immersed.size().unknowns, 3 * all.size());

    // ghosts have the positions that their owners have
    for (unsigned int d = 0; d < 3; ++d)
    {
      Vector X = immersed.make_vector();
      for (unsigned int node = 0; node < immersed.n_owned_nodes(); ++node)
        X.local_element(3 * node + d) = immersed.node_positions()[node][d];
      X.update_ghost_values();
      for (unsigned int node = 0; node < immersed.node_positions().size(); ++node)
        EXPECT_EQ(X.local_element(3 * node + d), immersed.node_positions()[node][d]);
    }
  }

  TEST(Immersed, ShapesAreLinearlyComplete)
  {
    // hanging nodes around the inner cell, and with two refinements beside hanging ones
    const auto body = make_sphere(0.5);
    for (const char *rule : {"finite cell", "weighted cell"})
      for (unsigned int degree = 1; degree <= 3; ++degree)
        for (unsigned int refinement = 0; refinement <= 2; ++refinement)
        {
          const Immersed immersed(rule, degree, cells_across(3, refinement), {1, 0}, *body,
                                  MPI_COMM_WORLD);
          EXPECT_LT(linear_defect(immersed), 1e-12) << rule << " " << degree << " " << refinement;
        }
  }

  /// The search for the few ends where an iteration gains little, so not always at rounding.
  TEST(Immersed, EachCellOfMomentFittingIntegratesGradientsAsThatOfFiniteCell)
  {
    std::vector<std::unique_ptr<Body>> bodies;
    bodies.push_back(make_sphere(0.5));
    bodies.push_back(make_torus(0.7, 0.4));
    bodies.push_back(std::make_unique<SurfaceBody>(turned_box_surface(Point(1, 1.25, 1.5))));
    for (const auto &body : bodies)
    {
      const Immersed few("moment fitting", 1, cells_across(4), {2}, *body, MPI_COMM_SELF),
        many("finite cell", 1, cells_across(4), {2}, *body, MPI_COMM_SELF);
      ASSERT_EQ(few.n_patches(), many.n_patches());
      PatchStorage storage;
      for (unsigned int i = 0; i < few.n_patches(); ++i)
      {
        EXPECT_LE(few.patch(i, storage).n_points(), 8u);
        const std::vector<double> found = integrated_gradients(few.patch(i, storage)),
                                  exact = integrated_gradients(many.patch(i, storage));
        ASSERT_EQ(found.size(), exact.size());
        double largest = 0;
        for (const double value : exact)
          largest = std::max(largest, std::abs(value));
        for (unsigned int k = 0; k < exact.size(); ++k)
          EXPECT_NEAR(found[k], exact[k], 1e-9 * largest) << "cell " << i;
      }
    }
  }

  TEST(Immersed, HangingNodesCarryNoUnknowns)
  {
    const auto body = make_sphere(0.5);
    const Immersed immersed("weighted cell", 1, cells_across(8, 1), {2, 0}, *body, MPI_COMM_WORLD);
    // in the middle of an edge or a face of a coarse cell
    unsigned int n_on_edge = 0, n_on_face = 0;
    for (const PointShapes &point : immersed.drawn_cells().shapes)
    {
      n_on_edge += point.values == std::vector<double>(2, 0.5);
      n_on_face += point.values == std::vector<double>(4, 0.25);
      EXPECT_EQ(std::accumulate(point.values.begin(), point.values.end(), 0.), 1);
    }
    EXPECT_GT(dealii::Utilities::MPI::sum(n_on_edge, MPI_COMM_WORLD), 0u);
    EXPECT_GT(dealii::Utilities::MPI::sum(n_on_face, MPI_COMM_WORLD), 0u);
    // Leaves of 1/64 see up to 0.29 of their height too much or too little. That adds up where the
    // ball lies along the grid, in six caps as high as a leaf, with areas of 2 pi R / 64; elsewhere
    // errors are random, less than a fifth of that.
    EXPECT_NEAR(seen_volume(immersed), M_PI / 6, 6 * 0.29 / 64 * M_PI / 64 * 1.2);
  }

  TEST(Immersed, FindsTheShapesOfAPoint)
  {
    const auto body = make_sphere(1);
    for (unsigned int refinement = 0; refinement <= 1; ++refinement)
    {
      const Immersed immersed("finite cell", 2, cells_across(6, refinement), {1, 0}, *body,
                              MPI_COMM_WORLD);
      const auto check = [&](const Point &X, const double reach, const bool expected) {
        const auto shapes = immersed.shapes_at(X, reach);
        const bool found  = bool(shapes);
        EXPECT_EQ(dealii::Utilities::MPI::logical_or(found, MPI_COMM_WORLD), expected);
        if (!found)
          return;
        EXPECT_LE(shapes->claim.distance, reach + 1e-8);
        Direction Y;
        for (unsigned int i = 0; i < shapes->nodes.size(); ++i)
          Y += shapes->values[i] * immersed.node_positions()[shapes->nodes[i]];
        EXPECT_LT((Y - X).norm(), 1e-9 * (1 + std::pow(shapes->claim.distance, 6)));
      };
      check(Point(0, 0, 0.1), 0, true);
      check(Point(0.1, -0.2, 1.3), 0, true);
      check(Point(0.1, 0.1, 2), 0, true); // on the grid's upper end
      check(Point(0.1, 0.1, 2.05), 0, false);
      check(Point(0.1, 0.1, 2.05), 0.06, true);
      check(Point(5, 0.1, 1), 4.1, true);
      check(Point(5, 0.1, 1), 3.9, false);
    }
  }

  TEST(Immersed, DrawsItsCells)
  {
    const auto body = make_sphere(1);
    for (unsigned int degree = 1; degree <= 2; ++degree)
    {
      const Immersed immersed("weighted cell", degree, cells_across(5, 1), {2, 0}, *body,
                              MPI_COMM_WORLD);
      const DrawnCells drawn = immersed.drawn_cells();
      const unsigned int n   = degree == 1 ? 8 : 27;
      ASSERT_EQ(drawn.types.size(), immersed.n_patches());
      ASSERT_EQ(drawn.connectivity.size(), n * immersed.n_patches());
      double filled = 0;
      for (unsigned int c = 0; c < drawn.types.size(); ++c)
      {
        const unsigned int *p = drawn.connectivity.data() + drawn.offsets[c];
        const auto X          = [&](const unsigned int i) { return drawn.points[p[i]]; };
        // VTK's corners 1, 3, 4 are the neighbours of 0 along x, y, z, and 6 is across
        EXPECT_NEAR((X(1) - X(0))[0], (X(6) - X(0))[0], 1e-14);
        EXPECT_NEAR((X(3) - X(0))[1], (X(6) - X(0))[1], 1e-14);
        EXPECT_NEAR((X(4) - X(0))[2], (X(6) - X(0))[2], 1e-14);
        filled += drawn.cut_fraction[c] * (X(1) - X(0)).norm() * (X(3) - X(0)).norm() *
                  (X(4) - X(0)).norm();
        if (degree == 2)
        {
          EXPECT_LT((X(26) - 0.5 * (X(0) + X(6))).norm(), 1e-14);
        }
      }
      EXPECT_NEAR(dealii::Utilities::MPI::sum(filled, MPI_COMM_WORLD), seen_volume(immersed),
                  1e-12);
      for (unsigned int i = 0; i < drawn.points.size(); ++i)
      {
        Direction X;
        for (unsigned int k = 0; k < drawn.shapes[i].nodes.size(); ++k)
          X += drawn.shapes[i].values[k] * immersed.node_positions()[drawn.shapes[i].nodes[k]];
        EXPECT_LT((X - drawn.points[i]).norm(), 1e-13);
      }
    }
  }

  TEST(Immersed, RefusesToMissTheBody)
  {
    const auto body                = make_torus(1, 0.05);
    GridParameters picky           = cells_across(1);
    picky.smallest_volume_fraction = 0.9;
    EXPECT_THROW(Immersed("finite cell", 1, picky, {1, 0}, *body, MPI_COMM_WORLD), BadInput);
  }
} // namespace softcell
