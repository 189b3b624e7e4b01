// SPDX-License-Identifier: LGPL-2.1-or-later
// Orders of errors that are known.

#include <softcell/studies/observed_rates.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace softcell;

namespace
{
  /// Errors h^2, h^(3/2) and h.
  ResultsRow row_of(const std::string &method, const double h, const char *const tissue = "soft")
  {
    ResultsRow row;
    row.set("method", method);
    row.set("tissue", tissue);
    row.set("cell_size", h);
    row.set("relative_l2_error", h * h);
    row.set("relative_h1_error", std::pow(h, 1.5));
    row.set("relative_stress_error", h);
    row.set("converged", true);
    return row;
  }
} // namespace

TEST(ObservedRates, AreTheOrdersInTheCellSizeWhateverTheOrderOfRows)
{
  std::vector<ResultsRow> rows = {row_of("a", 0.1), row_of("b", 0.4), row_of("a", 0.3),
                                  row_of("a", 0.2)};
  add_observed_rates(rows, {"tissue"});
  for (const unsigned int fine : {0, 3})
  {
    EXPECT_NEAR(rows[fine].number("observed_rate"), 2, 1e-12);
    EXPECT_NEAR(rows[fine].number("observed_rate_h1"), 1.5, 1e-12);
    EXPECT_NEAR(rows[fine].number("observed_rate_stress"), 1, 1e-12);
  }
  for (const unsigned int coarsest : {1, 2})
    EXPECT_EQ(rows[coarsest].get("observed_rate"), "");
}

TEST(ObservedRates, LeaveOutWhatFailedAndOtherSeries)
{
  std::vector<ResultsRow> rows = {row_of("a", 0.4), row_of("a", 0.2), row_of("a", 0.1),
                                  row_of("a", 0.05, "stiff")};
  rows[1].set("converged", false);
  rows[1].set("relative_l2_error", 7.);
  rows[3].set("observed_rate", 9.); // of an earlier run
  add_observed_rates(rows, {"tissue"});
  EXPECT_EQ(rows[1].get("observed_rate"), "");
  EXPECT_NEAR(rows[2].number("observed_rate"), 2, 1e-12);
  EXPECT_EQ(rows[3].get("observed_rate"), "");
  add_observed_rates(rows, {});
  EXPECT_NEAR(rows[3].number("observed_rate"), 2, 1e-12);
}
