// SPDX-License-Identifier: LGPL-2.1-or-later
// Which mesh a user gets for what is asked.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/mesh.h>

#include <gtest/gtest.h>

#include <fstream>

namespace softcell
{
  namespace
  {
    struct Wish
    {
      std::string type;
      CellShape shape;
      std::vector<unsigned int> cells;
      MeshParameters parameters        = {};
      std::vector<std::string> remarks = {};

      Mesh mesh()
      {
        GeometryParameters geometry;
        geometry.type   = type;
        geometry.radius = 0.5;
        geometry.length = 2;
        geometry.size   = Point(2, 1, 3);
        const auto body = make_body(geometry, remarks);
        return make_mesh(MPI_COMM_WORLD, shape, cells, parameters, geometry, *body, remarks);
      }

      std::string complaint()
      {
        try
        {
          mesh();
        }
        catch (const BadInput &error)
        {
          return error.what();
        }
        return "";
      }
    };
  } // namespace

  TEST(Mesh, HasCubicCellsOrAsManyAsAsked)
  {
    EXPECT_EQ((Wish{"box", CellShape::hexahedra, {2}}.mesh().n_cells()), 4u * 2 * 6);
    EXPECT_EQ((Wish{"box", CellShape::hexahedra, {2, 3, 5}}.mesh().n_cells()), 30u);
    EXPECT_EQ((Wish{"box", CellShape::tetrahedra, {2}}.mesh().n_cells()), 6u * 48);
    // A core of 2 x 2 and a ring of 8 cells, 8 layers.
    EXPECT_EQ((Wish{"cylinder", CellShape::hexahedra, {4}}.mesh().n_cells()), 12u * 8);
    EXPECT_NE(
      (Wish{"box", CellShape::hexahedra, {2, 3}}.complaint().find("Cells = 2, 3 has two numbers")),
      std::string::npos);
  }

  TEST(Mesh, IsMadeByCgalWhereASizeIsGiven)
  {
    Wish wish{"box", CellShape::tetrahedra, {2}, {1., ""}};
    const std::size_t n_cells = wish.mesh().n_cells();
    // Regular tetrahedra of edge 1 in 6 m^3 would be 51; protected edges take smaller ones.
    EXPECT_GT(n_cells, 51u);
    EXPECT_LT(n_cells, 500u);
    EXPECT_TRUE(wish.remarks.empty());
  }

  TEST(Mesh, SaysWhenItIsTooCoarseForTheBody)
  {
    Wish wish{"sphere", CellShape::tetrahedra, {2}, {10., ""}};
    wish.mesh();
    ASSERT_EQ(wish.remarks.size(), 1u);
    EXPECT_NE(wish.remarks[0].find("smaller Discretization/Mesh size"), std::string::npos);
  }

  TEST(Mesh, OffersHexahedraWhereTheyFit)
  {
    EXPECT_NE((Wish{"sphere", CellShape::hexahedra, {4}}.complaint().find(
                "available for Geometry/Type = box and cylinder, not for 'sphere'")),
              std::string::npos);
    EXPECT_NE((Wish{"cylinder", CellShape::hexahedra, {2}}.complaint().find("at least 3 across")),
              std::string::npos);
  }

  TEST(Mesh, WantsAFileOfTheSameCells)
  {
    const std::string file =
      testing::TempDir() + "softcell_tetrahedron_" +
      std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + ".msh";
    std::ofstream(file) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n"
                           "3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n"
                           "$EndElements\n";
    EXPECT_EQ((Wish{"box", CellShape::tetrahedra, {2}, {0., file}}.mesh().n_cells()), 1u);
    EXPECT_NE((Wish{"box", CellShape::hexahedra, {2}, {0., file}}.complaint().find(
                "holds tetrahedra; set Discretization/Method")),
              std::string::npos);
  }

  // Two cells on either side of a face, the second numbered backwards, and with its far corners
  // moved to the first one's side.
  TEST(Mesh, IsRefusedWhereCellsOverlap)
  {
    const auto file = [](const std::string &name, const std::string &nodes,
                         const std::string &elements) {
      const std::string path =
        testing::TempDir() + "softcell_" + name +
        std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + ".msh";
      std::ofstream(path) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
                          << nodes << "$EndNodes\n$Elements\n2\n"
                          << elements << "$EndElements\n";
      return path;
    };
    for (const double z : {-1., 0.5})
    {
      const std::string height = std::to_string(z) + '\n';
      Wish tetrahedra{"box", CellShape::tetrahedra, {2}};
      tetrahedra.parameters.file =
        file("pair", "5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 " + height,
             "1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 5\n");
      Wish hexahedra{"box", CellShape::hexahedra, {2}};
      hexahedra.parameters.file =
        file("bricks",
             "12\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 0 0 " +
               height + "10 1 0 " + height + "11 1 1 " + height + "12 0 1 " + height,
             "1 5 2 1 1 1 2 3 4 5 6 7 8\n2 5 2 1 1 1 2 3 4 9 10 11 12\n");
      for (Wish *wish : {&tetrahedra, &hexahedra})
      {
        const std::string complaint = wish->complaint();
        EXPECT_EQ(complaint.find("1 pair(s) of its 2 cells") != std::string::npos, z > 0)
          << complaint;
        EXPECT_EQ(complaint.empty(), z < 0) << complaint;
      }
    }
  }
} // namespace softcell
