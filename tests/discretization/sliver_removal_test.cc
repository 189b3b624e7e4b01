// SPDX-License-Identifier: LGPL-2.1-or-later
// Slivers inside a mesh and on its boundary.

#include <softcell/discretization/sliver_removal.h>
#include <softcell/discretization/tetrahedral_mesh.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    double worst(const Mesh &mesh)
    {
      double result = 1;
      for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
        result = std::min(result, quality(mesh, cell));
      return result;
    }
  } // namespace

  TEST(SliverRemoval, MeasuresQuality)
  {
    Mesh mesh;
    mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, {0.5, 0.5, 0.}};
    mesh.corners  = {0, 1, 3, 2};
    EXPECT_NEAR(quality(mesh, 0), 1, 1e-14);
    mesh.corners = {0, 1, 2, 3};
    EXPECT_NEAR(quality(mesh, 0), -1, 1e-14);
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(quality(mesh, 0), 0);
  }

  TEST(SliverRemoval, MovesVerticesInside)
  {
    Mesh mesh         = kuhn_box(Point(1, 1, 1), {{2, 2, 2}});
    const double good = worst(mesh);
    std::vector<bool> movable(mesh.vertices.size(), false);
    movable[13]       = true; // the middle of 27
    mesh.vertices[13] = Point(0.5, 0.52, 0.97);
    ASSERT_LT(worst(mesh), 0.15 * good);
    const Mesh before = mesh;
    remove_slivers(mesh, movable);
    EXPECT_GT(worst(mesh), 0.3);
    EXPECT_NEAR(volume(mesh), 1, 1e-14);
    EXPECT_EQ(mesh.corners, before.corners);
    for (unsigned int v = 0; v < 27; ++v)
      EXPECT_TRUE(v == 13 || mesh.vertices[v] == before.vertices[v]);
  }

  TEST(SliverRemoval, DropsFlatCellsOfTheBoundary)
  {
    // A cube without its lid, and over it a cell as flat as a leaf on two triangles.
    Mesh mesh                 = kuhn_box(Point(1, 1, 1), {{1, 1, 1}});
    const std::size_t n_cells = mesh.n_cells();
    mesh.vertices[7][2]       = 1.02;
    // The lid's corners are 4 to 7; its diagonal from 4 to 7 is an edge of the mesh, that from 5 to
    // 6 the leaf's.
    mesh.corners.insert(mesh.corners.end(), {4, 5, 7, 6});
    if (quality(mesh, n_cells) < 0)
      std::swap(mesh.corners[4 * n_cells], mesh.corners[4 * n_cells + 1]);
    ASSERT_GT(quality(mesh, n_cells), 0);
    ASSERT_LT(quality(mesh, n_cells), 0.1);
    remove_slivers(mesh, std::vector<bool>(8, false));
    EXPECT_EQ(mesh.n_cells(), n_cells);
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      EXPECT_GT(quality(mesh, cell), 0.1);
  }
} // namespace softcell
