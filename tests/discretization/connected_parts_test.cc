// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of a body on any number of ranks.

#include "../box_of_cells.h"

#include <softcell/discretization/connected_parts.h>
#include <softcell/discretization/fitted.h>
#include <softcell/discretization/hexahedral_mesh.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

namespace softcell
{
  // Two bars of 1 m side by side with a gap of 1 m, cut across by the ranks.
  TEST(ConnectedParts, AreTheBarsOfAMesh)
  {
    Mesh mesh                = hexahedral_box(Point(1, 1, 9), {{2, 2, 18}});
    const unsigned int n     = mesh.vertices.size();
    const std::size_t n_here = mesh.corners.size();
    for (unsigned int i = 0; i < n; ++i)
      mesh.vertices.push_back(mesh.vertices[i] + Direction({2, 0, 0}));
    for (std::size_t i = 0; i < n_here; ++i)
      mesh.corners.push_back(mesh.corners[i] + n);
    const auto body = make_box(Point(1, 1, 9));
    const Fitted bars(MPI_COMM_WORLD, mesh, 1, *body);
    const std::vector<unsigned int> parts = connected_parts(bars);
    unsigned int lowest[]                 = {2 * n, 2 * n};
    ASSERT_EQ(parts.size(), bars.node_positions().size());
    for (unsigned int i = 0; i < parts.size(); ++i)
    {
      unsigned int &number = lowest[bars.node_positions()[i][0] > 1.5];
      number               = std::min(number, parts[i]);
    }
    for (unsigned int &number : lowest)
      number = dealii::Utilities::MPI::min(number, MPI_COMM_WORLD);
    EXPECT_NE(lowest[0], lowest[1]);
    EXPECT_EQ(std::min(lowest[0], lowest[1]), 0u);
    for (unsigned int i = 0; i < parts.size(); ++i)
      EXPECT_EQ(parts[i], lowest[bars.node_positions()[i][0] > 1.5]) << bars.node_positions()[i];
  }

  TEST(ConnectedParts, AreOneWhereCellsShareNodes)
  {
    const BoxOfCells box({2, 2, 8}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const unsigned int part : connected_parts(box))
      EXPECT_EQ(part, 0u);
  }
} // namespace softcell
