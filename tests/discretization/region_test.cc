// SPDX-License-Identifier: LGPL-2.1-or-later
// Regions told by expressions and by patch numbers.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/region.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Direction up({0, 0, 1}), down({0, 0, -1});

    std::string message(const std::string &condition)
    {
      try
      {
        Region("rim", condition);
      }
      catch (const BadInput &error)
      {
        return error.what();
      }
      return "";
    }
  } // namespace

  TEST(Region, ComparesPositionAndNormal)
  {
    const Region base("base", "z < 1e-6 && nz < -0.5 || x > 2");
    EXPECT_EQ(base.name(), "base");
    EXPECT_TRUE(base.contains(Point(0, 0, 0), down, 0));
    EXPECT_FALSE(base.contains(Point(0, 0, 0), up, 0));
    EXPECT_FALSE(base.contains(Point(0, 0, 1), down, 0));
    EXPECT_TRUE(base.contains(Point(3, 0, 1), up, 0));
  }

  TEST(Region, KnowsEveryVariableAndPi)
  {
    const Region all("all", "x==1 && y==2 && z==3 && nx==4 && ny==5 && nz==6 && cos(pi) < -0.9");
    EXPECT_TRUE(all.contains(Point(1, 2, 3), Direction({4, 5, 6}), 0));
    for (unsigned int i = 0; i < 3; ++i)
    {
      Point X(1, 2, 3);
      Direction n({4, 5, 6});
      X[i] += 0.5;
      EXPECT_FALSE(all.contains(X, n, 0));
      n[i] += 0.5;
      EXPECT_FALSE(all.contains(Point(1, 2, 3), n, 0));
    }
  }

  TEST(Region, TakesPatchesByNumber)
  {
    const Region third("third", " patch 3 ");
    EXPECT_TRUE(third.contains(Point(), up, 3));
    EXPECT_FALSE(third.contains(Point(), up, 2));
  }

  TEST(Region, SaysWhatIsWrong)
  {
    for (const std::string condition :
         {"z < ", "w < 1", "z = 0", "", "patch", "patch -1", "sin(x", "patch 99999999999"})
    {
      const std::string text = message(condition);
      EXPECT_NE(text.find("Regions/rim = '" + condition + "'"), std::string::npos) << condition;
      EXPECT_NE(text.find("z < 0.01 && nz < 0"), std::string::npos) << condition;
    }
    EXPECT_NE(message("w < 1").find("\"w\""), std::string::npos) << message("w < 1");
    EXPECT_NE(message("z = 0").find("'=='"), std::string::npos);
    EXPECT_EQ(message("z <= 0 && z >= -1 && z != 2 && z == 1"), "");
  }
} // namespace softcell
