// SPDX-License-Identifier: LGPL-2.1-or-later
// What a user is told of the discretization that was made.

#include <softcell/discretization/methods.h>

#include <gtest/gtest.h>

namespace softcell
{
  // Of a ball 16 cells across, a third of the cells are cut and half filled on the average.
  TEST(Methods, SayWhenCellsLoseMuchOfTheBody)
  {
    GeometryParameters geometry;
    geometry.type   = "sphere";
    geometry.radius = 0.5;
    std::vector<std::string> remarks;
    const auto body = make_body(geometry, remarks);
    DiscretizationParameters parameters;
    parameters.method     = "weighted cell";
    parameters.grid.cells = {16};
    make_discretization(parameters, geometry, *body, MPI_COMM_WORLD, remarks);
    EXPECT_TRUE(remarks.empty());
    parameters.grid.smallest_volume_fraction = 0.9;
    make_discretization(parameters, geometry, *body, MPI_COMM_WORLD, remarks);
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_NE(remarks[0].find("smaller Smallest volume fraction"), std::string::npos) << remarks[0];
  }
} // namespace softcell
