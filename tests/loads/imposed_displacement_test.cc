// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed on nodes.

#include "../box_of_cells.h"

#include <softcell/base/exceptions.h>
#include <softcell/loads/imposed_displacement.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Region bottom("bottom", "nz < -0.5"), side("side", "nx < -0.5");
  }

  TEST(ImposedDisplacement, TellsWhatIsMissing)
  {
    const BoxOfCells body({2, 2, 4}, Point(1, 1, 1), MPI_COMM_WORLD);
    ImposedDisplacement imposed(body);
    imposed.add("bottom", *body.nodes_on(bottom), Expression("0.5*y, free, 2*t", 3, ""));
    Vector u       = nodal_values(body, [](const Point &) { return Direction({0.1, 0.1, 0.1}); });
    Vector missing = body.make_vector();
    imposed.missing(u, 0.5, missing);
    for (unsigned int i = 0; i < 3 * body.node_positions().size(); ++i)
    {
      const Point &X        = body.node_positions()[i / 3];
      const double g[3]     = {0.5 * X[1], 0, 1.}; // at t = 0.5, `2*t` is not scaled again
      const double expected = X[2] > 1e-12 || i % 3 == 1 ? 0 : (i % 3 == 0 ? g[0] : g[2]) - 0.1;
      EXPECT_NEAR(missing.local_element(i), expected, 1e-14) << X << " component " << i % 3;
    }
  }

  TEST(ImposedDisplacement, SumsReactionsByRegion)
  {
    const BoxOfCells body({2, 2, 4}, Point(1, 1, 1), MPI_COMM_WORLD);
    ImposedDisplacement imposed(body);
    imposed.add("bottom", *body.nodes_on(bottom), Expression("0, 0, 0", 3, ""));
    imposed.add("side", *body.nodes_on(side), Expression("0, free, 0", 3, ""));
    const Vector ones    = nodal_values(body, [](const Point &) { return Direction({1, 2, 3}); });
    const auto reactions = imposed.reactions(ones);
    ASSERT_EQ(imposed.regions(), (std::vector<std::string>{"bottom", "side"}));
    EXPECT_EQ(reactions[0], 9. * Direction({1, 2, 3}));  // 3 x 3 nodes
    EXPECT_EQ(reactions[1], 12. * Direction({1, 0, 3})); // 3 x 5 nodes less the 3 shared ones
  }

  TEST(ImposedDisplacement, RefusesContradictions)
  {
    const BoxOfCells body({2, 2, 4}, Point(1, 1, 1), MPI_COMM_WORLD);
    ImposedDisplacement imposed(body);
    imposed.add("bottom", *body.nodes_on(bottom), Expression("0, 0, 0", 3, "Loads/bottom"));
    EXPECT_NO_THROW(
      imposed.add("side", *body.nodes_on(side), Expression("0, z, 0", 3, "Loads/side")));
    try
    {
      imposed.add("side", *body.nodes_on(side), Expression("0, z, 0.1", 3, "Loads/other"));
      FAIL();
    }
    catch (const BadInput &error)
    {
      const std::string message = error.what();
      EXPECT_NE(message.find("Loads/bottom and Loads/other impose 0 m and 0.1 m along z"),
                std::string::npos)
        << message;
    }
  }
} // namespace softcell
