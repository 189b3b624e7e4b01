// SPDX-License-Identifier: LGPL-2.1-or-later
// What is foreseen against what is made.

#include <softcell/base/block_matrix.h>
#include <softcell/discretization/expected_size.h>

#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    struct Case
    {
      std::string method, type;
      unsigned int degree, refinement;
      double ghost_penalty = 0;
    };

    /// Pairs of nodes that a tangent couples.
    double n_couplings(const Discretization &discretization)
    {
      std::vector<std::vector<unsigned int>> lists;
      PatchStorage storage;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
      {
        const auto nodes = discretization.patch(i, storage).nodes;
        lists.emplace_back(nodes.begin(), nodes.end());
      }
      for (const GhostFace &face : discretization.ghost_faces())
        lists.push_back(face.nodes);
      const BlockMatrix matrix(discretization.partitioner(), lists);
      const double n_here = matrix.row_start()[discretization.n_owned_nodes()];
      return dealii::Utilities::MPI::sum(n_here, discretization.communicator());
    }
  } // namespace

  TEST(ExpectedSize, IsNearWhatIsMade)
  {
    for (const Case &one : {Case{"weighted cell", "cylinder", 1, 0},
                            {"weighted cell", "sphere", 2, 0},
                            {"finite cell", "sphere", 1, 2},
                            {"finite cell", "sphere", 1, 0, 0.1},
                            {"weighted cell", "sphere", 2, 0, 0.1},
                            {"sparse grid", "box", 1, 0},
                            {"hexahedra", "cylinder", 2, 0},
                            {"tetrahedra", "box", 1, 0},
                            {"tetrahedra", "sphere", 1, 0},
                            {"tetrahedra", "sphere", 2, 0}})
    {
      SCOPED_TRACE(one.method + ' ' + one.type + ' ' + std::to_string(one.degree));
      GeometryParameters geometry;
      geometry.type   = one.type;
      geometry.radius = 0.5;
      geometry.length = 1;
      DiscretizationParameters parameters;
      parameters.method                  = one.method;
      parameters.degree                  = one.degree;
      parameters.grid.cells              = {12};
      parameters.grid.surface_refinement = one.refinement;
      parameters.cut.levels              = one.ghost_penalty > 0 ? 3 : 1; // fewer miss slivers
      parameters.cut.ghost_penalty       = one.ghost_penalty;
      std::vector<std::string> remarks;
      const auto body = make_body(geometry, remarks);

      const ExpectedSize expected = expected_size(parameters, geometry, *body);
      const auto made = make_discretization(parameters, geometry, *body, MPI_COMM_WORLD, remarks);
      const Size size = made->size();
      EXPECT_NEAR(expected.cells, size.cells, 0.2 * size.cells);
      const double couplings = n_couplings(*made);
      EXPECT_NEAR(expected.couplings, couplings, 0.25 * couplings);
      const double faces =
        dealii::Utilities::MPI::sum(double(made->ghost_faces().size()), MPI_COMM_WORLD);
      EXPECT_NEAR(expected.ghost_faces, faces, 0.25 * faces);
      // of 12 cells, the nodes on the far side count too: (1 + 1/12)^3
      EXPECT_NEAR(3 * expected.nodes, size.unknowns, 0.3 * size.unknowns);
      if (size.cut_cells > 0 && one.type == "sphere") // flat ends may lie between cells
      {
        EXPECT_NEAR(expected.cut_cells, size.cut_cells, 0.25 * size.cut_cells);
      }
    }
  }
} // namespace softcell
