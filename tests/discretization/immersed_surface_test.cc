// SPDX-License-Identifier: LGPL-2.1-or-later
// Pieces of surface: each once, with the body's area.

#include "../box_surface.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/geometry/surface.h>
#include <softcell/geometry/surface_body.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    GridParameters
    scaled_grid(const unsigned int n, const double scale = 1, const unsigned int refinement = 0)
    {
      GridParameters parameters;
      parameters.cells              = {n};
      parameters.scale              = scale;
      parameters.surface_refinement = refinement;
      return parameters;
    }
  } // namespace

  TEST(ImmersedSurface, EveryPieceAppearsOnce)
  {
    struct Case
    {
      std::unique_ptr<Body> body;
      double area;
      bool is_curved;
    };
    std::vector<Case> cases;
    cases.push_back({make_box(Point(0.1, 0.2, 0.15)), 0.13, false});
    cases.push_back({make_hexagonal_prism(0.05, 0.2), 0.06 + 0.0075 * std::sqrt(3.), false});
    cases.push_back({make_cylinder(0.05, 0.2), 0.025 * M_PI, true});
    cases.push_back({make_sphere(0.05), 0.01 * M_PI, true});
    cases.push_back({make_hollow_sphere(0.05, 0.02), 0.0116 * M_PI, true});
    cases.push_back({make_torus(0.1, 0.04), 0.016 * M_PI * M_PI, true});
    for (const auto &[body, true_area, is_curved] : cases)
      for (const double scale : {1., 1.37})
        for (unsigned int refinement = 0; refinement <= 1; ++refinement)
        {
          const Immersed immersed("weighted cell", 1, scaled_grid(4, scale, refinement), {2, 0},
                                  *body, MPI_COMM_WORLD);
          double area = 0, x_n = 0;
          Direction n;
          for (const SurfacePatch &patch : immersed.surface_patches(Region("all", "1")))
            for (unsigned int q = 0; q < patch.weights.size(); ++q)
            {
              area += patch.weights[q];
              n += patch.weights[q] * patch.normals[q];
              x_n += patch.weights[q] * (patch.points[q] * patch.normals[q]);
              Direction X; // the shapes find the point again, and are a partition of unity
              double unity = 0;
              for (unsigned int k = 0; k < patch.nodes.size(); ++k)
              {
                unity += patch.shapes.value(q)[k];
                X += patch.shapes.value(q)[k] * immersed.node_positions()[patch.nodes[k]];
              }
              ASSERT_NEAR(unity, 1, 1e-12);
              ASSERT_LT((X - patch.points[q]).norm(), 1e-12);
            }
          area = dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD);
          x_n  = dealii::Utilities::MPI::sum(x_n, MPI_COMM_WORLD);
          n    = dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD);
          // flat pieces are looked for 1e-9 of a cell inside; those of a cylinder's ends have kinks
          EXPECT_NEAR(area, true_area, (is_curved ? 4e-5 : 1e-9) * area);
          EXPECT_NEAR(x_n, 3 * body->volume(), (is_curved ? 4e-5 : 1e-7) * x_n);
          EXPECT_LT(n.norm(), (is_curved ? 1e-7 : 1e-9) * area);
        }
  }

  /// Faces of a box 1e-6 of a cell beyond the last cells that hold something.
  TEST(ImmersedSurface, PiecesBesideTheCellsGoToTheOneThatTheyLieOn)
  {
    const auto body = make_box(Point(1, 1, 1));
    const Immersed immersed("finite cell", 1, scaled_grid(6, 3 / (2 + 1e-6)), {2, 0}, *body,
                            MPI_COMM_WORLD);
    ASSERT_EQ(immersed.size().cells, 64);
    double area = 0;
    for (const SurfacePatch &patch : immersed.surface_patches(Region("all", "1")))
    {
      const Point &first = immersed.node_positions()[patch.nodes[0]];
      Box cell({first, first});
      for (const unsigned int node : patch.nodes)
      {
        const Point &X = immersed.node_positions()[node];
        cell.merge_with(Box({X, X}));
      }
      cell.extend(1.001e-6 * patch.cell_size);
      for (unsigned int q = 0; q < patch.points.size(); ++q)
      {
        EXPECT_TRUE(cell.point_inside(patch.points[q]));
        area += patch.weights[q];
      }
    }
    EXPECT_NEAR(dealii::Utilities::MPI::sum(area, MPI_COMM_WORLD), 6, 1e-8);
  }

  TEST(ImmersedSurface, FlushFacesHaveNodesThatDetermineThem)
  {
    const auto body = make_cylinder(0.05, 0.3);
    const Region base("base", "z < 1e-6"), side("side", "z > 1e-6 && z < 0.3 - 1e-6");
    for (unsigned int degree = 1; degree <= 2; ++degree)
    {
      const Immersed immersed("finite cell", degree, scaled_grid(4), {2, 0}, *body, MPI_COMM_WORLD);
      EXPECT_FALSE(immersed.nodes_on(side));
      const auto nodes = immersed.nodes_on(base);
      ASSERT_TRUE(nodes);
      // all 16 cells of the bottom layer are cut or inside
      unsigned int n_owned = 0;
      for (const unsigned int node : *nodes)
      {
        EXPECT_NEAR(immersed.node_positions()[node][2], 0, 1e-14);
        n_owned += node < immersed.n_owned_nodes();
      }
      EXPECT_EQ(dealii::Utilities::MPI::sum(n_owned, MPI_COMM_WORLD), std::pow(4 * degree + 1, 2));
    }
    const Immersed shifted("finite cell", 1, scaled_grid(4, 1.01), {2, 0}, *body, MPI_COMM_WORLD);
    EXPECT_FALSE(shifted.nodes_on(base));
  }

  /// Triangles of 1/8 on cells of 1/16: those cells have no nodes there that they only touch.
  TEST(ImmersedSurface, NodesOfARegionEndWhereItEnds)
  {
    const SurfaceBody body(box_surface(Point(1, 1, 1), 8));
    GridParameters grid;
    grid.cells = {16};
    const Immersed immersed("weighted cell", 1, grid, {1, 0}, body, MPI_COMM_WORLD);
    const auto nodes = immersed.nodes_on(Region("patch", "z < 1e-9 && x < 0.25 && y < 0.25"));
    ASSERT_TRUE(nodes);
    unsigned int n_owned = 0;
    for (const unsigned int node : *nodes)
    {
      n_owned += node < immersed.n_owned_nodes();
      EXPECT_LT(std::max(immersed.node_positions()[node][0], immersed.node_positions()[node][1]),
                0.25 + 1e-9);
    }
    EXPECT_EQ(dealii::Utilities::MPI::sum(n_owned, MPI_COMM_WORLD), 5u * 5);
  }

  TEST(ImmersedSurface, ARegionMustSelectSomething)
  {
    const auto body = make_sphere(1);
    const Immersed immersed("sparse grid", 1, scaled_grid(3), {0, 0}, *body, MPI_COMM_WORLD);
    EXPECT_THROW(immersed.surface_patches(Region("none", "z > 3")), BadInput);
    EXPECT_THROW(immersed.nodes_on(Region("none", "z > 3")), BadInput);
  }
} // namespace softcell
