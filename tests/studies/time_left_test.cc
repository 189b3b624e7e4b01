// SPDX-License-Identifier: LGPL-2.1-or-later
// Guesses of how long runs take.

#include <softcell/studies/time_left.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace softcell;

TEST(TimeLeft, ScalesTheNearestRunOfTheSameKind)
{
  TimeLeft left;
  EXPECT_TRUE(std::isnan(left.guess({"a", 1e4, 0})));
  left.add({"b", 1e9, 0}, 30);
  EXPECT_NEAR(left.guess({"a", 2e9, 0}), 60, 1e-6); // better than nothing
  left.add({"a", 1e6, 0}, 1);
  left.add({"a", 1e8, 0}, 50); // and not 100
  EXPECT_NEAR(left.guess({"a", 2e6, 0}), 2, 1e-4);
  EXPECT_NEAR(left.guess({"a", 1e9, 0}), 500, 1e-4);
}

TEST(TimeLeft, CountsIterationsThatGrowWithTheCellsAcross)
{
  TimeLeft left;
  left.add({"a", 0, 1e6}, 1);
  EXPECT_NEAR(left.guess({"a", 0, 8e6}), 16,
              1e-4); // eight times the unknowns, twice the iterations
}

TEST(TimeLeft, IsSaidInRoundUnits)
{
  EXPECT_EQ(duration(0.4), "0 s");
  EXPECT_EQ(duration(89), "89 s");
  EXPECT_EQ(duration(95), "2 min");
  EXPECT_EQ(duration(3 * 3600 + 20 * 60), "3 h 20 min");
}
