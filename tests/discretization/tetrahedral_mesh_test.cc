// SPDX-License-Identifier: LGPL-2.1-or-later
// Meshes of tetrahedra: volumes, sharp edges, labels, files, and the structured one.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/tetrahedral_mesh.h>
#include <softcell/geometry/shapes.h>
#include <softcell/geometry/surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace softcell
{
  namespace
  {
    std::array<Point, 4> corners(const Mesh &mesh, const std::size_t cell)
    {
      std::array<Point, 4> result;
      for (unsigned int v = 0; v < 4; ++v)
        result[v] = mesh.vertices[mesh.corners[4 * cell + v]];
      return result;
    }

    /// Mean edge, and the least of 6 sqrt(2) volume / (mean square edge)^(3/2), 1 for a regular
    /// tetrahedron.
    std::pair<double, double> edge_and_quality(const Mesh &mesh)
    {
      double sum = 0, worst = 1;
      for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
      {
        const auto v  = corners(mesh, cell);
        double square = 0;
        for (unsigned int i = 0; i < 4; ++i)
          for (unsigned int j = 0; j < i; ++j)
          {
            square += v[i].distance_square(v[j]) / 6;
            sum += v[i].distance(v[j]) / 6;
          }
        const double six_volumes =
          (v[3] - v[0]) * dealii::cross_product_3d(v[1] - v[0], v[2] - v[0]);
        worst = std::min(worst, std::sqrt(2.) * six_volumes / std::pow(square, 1.5));
      }
      return {sum / mesh.n_cells(), worst};
    }

    /// A box whose halves x < 1/2 and x > 1/2 have different labels.
    class Halves : public Body
    {
    public:
      Box bounding_box() const override
      {
        return box->bounding_box();
      }
      bool contains(const Point &X) const override
      {
        return box->contains(X);
      }
      Side classify(const Box &other) const override
      {
        return box->classify(other);
      }
      double filled_volume(const Box &other) const override
      {
        return box->filled_volume(other);
      }
      double volume() const override
      {
        return box->volume();
      }
      const Surface &surface() const override
      {
        return box->surface();
      }
      unsigned int n_labels() const override
      {
        return 2;
      }
      unsigned int label(const Point &X) const override
      {
        return X[0] > 0.5;
      }

    private:
      std::unique_ptr<Body> box = make_box(Point(1, 1, 1));
    };

    std::string complaint(const std::string &file)
    {
      try
      {
        read_gmsh(MPI_COMM_WORLD, file, 1);
      }
      catch (const BadInput &error)
      {
        return error.what();
      }
      return "";
    }
  } // namespace

  TEST(TetrahedralMesh, MeshesSmoothBodies)
  {
    const double pi                                                    = dealii::numbers::PI;
    const std::vector<std::pair<std::unique_ptr<Body>, double>> bodies = [&] {
      std::vector<std::pair<std::unique_ptr<Body>, double>> result;
      result.emplace_back(make_sphere(0.5), pi / 6);
      result.emplace_back(make_torus(1, 0.4), 2 * pi * pi * 0.16);
      return result;
    }();
    for (const auto &[body, exact] : bodies)
    {
      const double size = 0.2;
      const Mesh mesh   = tetrahedral_mesh(MPI_COMM_WORLD, *body, size);
      EXPECT_NEAR(volume(mesh), exact, 0.06 * exact);
      const auto [edge, quality] = edge_and_quality(mesh);
      EXPECT_NEAR(edge, size, 0.2 * size);
      EXPECT_GT(quality, 0.1);
      for (const Point &X : mesh.vertices)
        EXPECT_TRUE(body->contains(X) || X.distance(body->surface().nearest(X).first) < 1e-6);
    }
  }

  TEST(TetrahedralMesh, KeepsSharpEdges)
  {
    const Mesh box = tetrahedral_mesh(MPI_COMM_WORLD, *make_box(Point(1, 1, 2)), 0.4);
    EXPECT_NEAR(volume(box), 2, 1e-6);

    const double length = 1, radius = 0.5;
    const Mesh cylinder = tetrahedral_mesh(MPI_COMM_WORLD, *make_cylinder(radius, length), 0.2);
    EXPECT_NEAR(volume(cylinder), dealii::numbers::PI / 4, 0.04);
    unsigned int on_base_rim = 0, on_top_rim = 0;
    for (const Point &X : cylinder.vertices)
      if (std::abs(std::hypot(X[0], X[1]) - radius) < 0.002)
      {
        on_base_rim += std::abs(X[2]) < 1e-9;
        on_top_rim += std::abs(X[2] - length) < 1e-9;
      }
    EXPECT_GE(on_base_rim, 15u);
    EXPECT_GE(on_top_rim, 15u);
  }

  TEST(TetrahedralMesh, IsTheSameEveryTimeAndEverywhere)
  {
    const auto body = make_sphere(0.5);
    const Mesh one  = tetrahedral_mesh(MPI_COMM_WORLD, *body, 0.3),
               two  = tetrahedral_mesh(MPI_COMM_SELF, *body, 0.3);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_EQ(one.corners, two.corners);
  }

  TEST(TetrahedralMesh, RespectsLabels)
  {
    const double size = 0.25;
    const Mesh mesh   = tetrahedral_mesh(MPI_COMM_WORLD, Halves(), size);
    double left       = 0;
    for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
    {
      // How deep a cell reaches across the interface: by the facets' tolerance, and by more only
      // along the interface's rim, which is not kept.
      const auto v = corners(mesh, cell);
      double below = 0, above = 0, rim = 1;
      for (const Point &X : v)
      {
        below = std::max(below, 0.5 - X[0]);
        above = std::max(above, X[0] - 0.5);
        rim   = std::min({rim, X[1], X[2], 1 - X[1], 1 - X[2]});
      }
      EXPECT_LT(std::min(below, above), (rim > 0.1 ? 0.1 : 0.3) * size);
      if (below > above)
        left += (v[3] - v[0]) * dealii::cross_product_3d(v[1] - v[0], v[2] - v[0]) / 6;
    }
    EXPECT_NEAR(left, volume(mesh) / 2, 0.01);
  }

  TEST(TetrahedralMesh, CutsBoxesAsKuhn)
  {
    const std::array<unsigned int, 3> n = {{3, 2, 4}};
    const Point size(1.5, 2, 1);
    const Mesh mesh = kuhn_box(size, n);
    EXPECT_EQ(mesh.vertices.size(), 4u * 3 * 5);
    EXPECT_EQ(mesh.n_cells(), 6u * 24);
    for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
    {
      const auto v = corners(mesh, cell);
      EXPECT_NEAR((v[3] - v[0]) * dealii::cross_product_3d(v[1] - v[0], v[2] - v[0]),
                  size[0] * size[1] * size[2] / 24, 1e-14);
      unsigned int diagonals = 0;
      for (const Point &a : v)
        for (const Point &b : v)
          diagonals += (b - a - Direction({0.5, 1, 0.25})).norm() < 1e-14;
      EXPECT_EQ(diagonals, 1u);
    }
  }

  TEST(TetrahedralMesh, ReadsGmshFiles)
  {
    const std::string folder = std::string(SOFTCELL_ORGANS) + "/liver_sofa/";
    if (!std::filesystem::exists(folder + "liver_tet_v2.msh"))
      GTEST_SKIP() << "no organs here";
    const Mesh two = read_gmsh(MPI_COMM_WORLD, folder + "liver_tet_v2.msh", 0.1);
    EXPECT_EQ(two.n_cells(), 596u);
    EXPECT_EQ(two.vertices.size(), 181u);
    EXPECT_NEAR(volume(two), 36.56e-3, 0.005e-3);
    const Mesh one = read_gmsh(MPI_COMM_WORLD, folder + "liver.msh", 0.1);
    EXPECT_EQ(one.n_cells(), 596u);
    EXPECT_NEAR(volume(one), volume(two), 1e-12);
  }

  TEST(TetrahedralMesh, ReadsPatchesAndSaysWhatIsWrongWithAFile)
  {
    const std::string stem =
      testing::TempDir() + "softcell_mesh_" +
      std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    std::ofstream(stem + ".msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n"
         "3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n2\n1 2 2 7 1 1 2 3\n"
         "2 4 2 1 1 1 2 3 4\n$EndElements\n";
    std::ofstream(stem + "_1.msh") << "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n"
                                      "$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n";
    std::ofstream(stem + "_cube.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n"
         "4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n"
         "1 5 2 0 0 1 2 3 4 5 6 7 8\n$EndElements\n";
    std::ofstream(stem + "_broken.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1";
    const Mesh mesh = read_gmsh(MPI_COMM_SELF, stem + ".msh", 2);
    EXPECT_NEAR(volume(mesh), 8. / 6, 1e-14);
    ASSERT_EQ(mesh.face_patches, std::vector<unsigned int>{7});
    double height = 0;
    for (const unsigned int v : mesh.face_corners)
      height += mesh.vertices[v][2];
    EXPECT_EQ(height, 0);
    EXPECT_NEAR(volume(read_gmsh(MPI_COMM_SELF, stem + "_1.msh", 2)), 8. / 6, 1e-14);
    EXPECT_NEAR(volume(read_gmsh(MPI_COMM_SELF, stem + "_cube.msh", 2)), 8, 1e-14);

    EXPECT_NE(complaint("nowhere.msh").find("Discretization/Mesh file = nowhere.msh: there is no"),
              std::string::npos);
    const std::string text = complaint(stem + "_broken.msh");
    EXPECT_NE(text.find("_broken.msh is cut short"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
} // namespace softcell
