// SPDX-License-Identifier: LGPL-2.1-or-later
// What all cut-cell rules have in common.

#include <softcell/base/exceptions.h>
#include <softcell/quadrature/cut_rule.h>

#include <gtest/gtest.h>

#include "simple_bodies.h"

namespace softcell
{
  TEST(CutRule, AtLevelZeroEveryRuleIsTheSparseGrid)
  {
    const Ball body(1);
    const Box cell({Point(0.5, 0.5, 0), Point(1, 1, 1)}), beyond({Point(1, 1, 1), Point(2, 2, 2)});
    for (const char *name : {"finite cell", "weighted cell", "moment fitting", "sparse grid"})
    {
      const auto rule = make_cut_rule(name, {0}, 1, body);
      EXPECT_DOUBLE_EQ(rule->add(cell), cell.volume());
      EXPECT_EQ(rule->add(beyond), 0);
      EXPECT_TRUE(rule->has_cell_points());
      CutPoints result;
      rule->points(0, result);
      ASSERT_EQ(result.weights.size(), 8u);
      for (const double w : result.weights)
        EXPECT_DOUBLE_EQ(w, cell.volume() / 8);
    }
    EXPECT_DOUBLE_EQ(make_cut_rule("sparse grid", {3, 0}, 1, body)->add(cell), cell.volume());
  }

  TEST(CutRule, NamesAreThoseItMakes)
  {
    const Ball body(1);
    for (const std::string &name : cut_rule_names())
      EXPECT_TRUE(make_cut_rule(name, {2, 0}, 2, body));
    EXPECT_THROW(make_cut_rule("finite sell", {2, 0}, 2, body), BadInput);
  }
} // namespace softcell
