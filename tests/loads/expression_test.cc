// SPDX-License-Identifier: LGPL-2.1-or-later
// Values given as expressions.

#include <softcell/base/exceptions.h>
#include <softcell/loads/expression.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Point somewhere(1, 2, 3);

    std::string complaint(const std::string &text, const unsigned int n_components)
    {
      try
      {
        Expression(text, n_components, "Loads/top");
      }
      catch (const BadInput &error)
      {
        return error.what();
      }
      return "";
    }
  } // namespace

  TEST(Expression, GrowsWithTheLoadFactorUnlessItSpeaksOfTime)
  {
    const Expression plain("x + y, -z, 5", 3, ""), timed("max(t, 0.5), 2*t^2, x", 3, "");
    EXPECT_FALSE(plain.uses_time());
    EXPECT_EQ(plain.value(somewhere, 0.25), Direction({3, -3, 5}));
    EXPECT_EQ(plain.at_load_factor(somewhere, 0.5), Direction({1.5, -1.5, 2.5}));
    EXPECT_TRUE(timed.uses_time());
    EXPECT_EQ(timed.at_load_factor(somewhere, 0.25), Direction({0.5, 0.125, 1}));
    EXPECT_EQ(Expression("100 * 10^t", 1, "").value(somewhere, 2)[0], 1e4);
  }

  TEST(Expression, LeavesComponentsFree)
  {
    const Expression sliding("0.1, free, 0", 3, "");
    EXPECT_FALSE(sliding.is_free(0));
    EXPECT_TRUE(sliding.is_free(1));
    EXPECT_EQ(sliding.value(somewhere, 1), Direction({0.1, 0, 0}));
  }

  TEST(Expression, NamesWhatItCannotRead)
  {
    EXPECT_NE(complaint("1, 2", 3).find("Loads/top has 2 components; give 3"), std::string::npos);
    EXPECT_NE(complaint("1, 2, w", 3).find("'w'"), std::string::npos);
    EXPECT_NE(complaint("", 1), "");
    EXPECT_NE(complaint("1,,2", 3), "");
    EXPECT_NE(complaint("(1", 1), "");
    EXPECT_NE(complaint("(1, 2)", 1), "");
    EXPECT_NE(complaint("x = 3", 1).find("'==' does"), std::string::npos);
    EXPECT_EQ(complaint("x == 3 || y <= 2", 1), "");
  }
} // namespace softcell
