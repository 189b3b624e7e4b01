// SPDX-License-Identifier: LGPL-2.1-or-later
// Meshes of hexahedra: how many cells, how they lie, what they fill.

#include <softcell/discretization/hexahedral_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace softcell
{
  namespace
  {
    /// Of an upright prism: height times half the cross product of the base's diagonals.
    double prism_volume(const Mesh &mesh, const std::size_t cell)
    {
      const auto v = [&](const unsigned int i) {
        return mesh.vertices[mesh.corners[8 * cell + i]];
      };
      const Direction up = v(4) - v(0);
      return 0.5 * std::abs(up[2]) * dealii::cross_product_3d(v(3) - v(0), v(2) - v(1))[2];
    }

    double sum_of_volumes(const Mesh &mesh)
    {
      double sum = 0;
      for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
      {
        EXPECT_GT(prism_volume(mesh, cell), 0);
        sum += prism_volume(mesh, cell);
      }
      return sum;
    }
  } // namespace

  TEST(HexahedralMesh, FillsABoxWithEqualCells)
  {
    const Mesh mesh = hexahedral_box(Point(2, 1, 3), {{4, 3, 5}});
    EXPECT_EQ(mesh.corners_per_cell, 8u);
    EXPECT_EQ(mesh.n_cells(), 60u);
    EXPECT_EQ(mesh.vertices.size(), 5u * 4 * 6);
    for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
      EXPECT_NEAR(prism_volume(mesh, cell), 0.1, 1e-14);
  }

  TEST(HexahedralMesh, FillsACylinder)
  {
    const double radius = 0.05, length = 0.2;
    for (const unsigned int across : {3, 4, 5, 6, 8, 11})
    {
      const Mesh mesh = hexahedral_cylinder(radius, length, across, 7);

      // Straight cells fill the prism over the regular polygon that the outermost points form.
      std::set<unsigned int> rim;
      for (unsigned int i = 0; i < mesh.vertices.size(); ++i)
        if (std::abs(std::hypot(mesh.vertices[i][0], mesh.vertices[i][1]) - radius) < 1e-12)
          rim.insert(i);
      ASSERT_EQ(rim.size() % 8, 0u);
      const double n = rim.size() / 8.;
      EXPECT_NEAR(sum_of_volumes(mesh),
                  length * n / 2 * radius * radius * std::sin(2 * dealii::numbers::PI / n), 1e-15);
      EXPECT_EQ(mesh.mantle_radius, radius);

      // An even number of cells across has that many edges on the diameter along x.
      std::set<double> places;
      for (const Point &X : mesh.vertices)
        if (X[2] == 0 && std::abs(X[1]) < 1e-12)
          places.insert(std::round(X[0] * 1e9));
      EXPECT_EQ(places.size(), across % 2 == 0 ? across + 1 : 0) << across;
    }
  }
} // namespace softcell
