// SPDX-License-Identifier: LGPL-2.1-or-later
// Orders from one size of cells to the next.

#include <softcell/studies/observed_rates.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace softcell
{
  namespace
  {
    void set_rate(const ResultsRow &coarse,
                  ResultsRow &fine,
                  const std::string &error,
                  const std::string &rate)
    {
      const double refinement = coarse.number("cell_size") / fine.number("cell_size");
      const double order =
        std::log(coarse.number(error) / fine.number(error)) / std::log(refinement);
      if (refinement > 1 && std::isfinite(order))
        fine.set(rate, order);
    }
  } // namespace

  void add_observed_rates(std::vector<ResultsRow> &rows, const std::vector<std::string> &columns)
  {
    std::map<std::vector<std::string>, std::vector<ResultsRow *>> series;
    for (ResultsRow &row : rows)
    {
      std::vector<std::string> key = {row.get("method"), row.get("degree"), row.get("cut_levels")};
      for (const std::string &column : columns)
        key.push_back(row.get(column));
      for (const char *const rate : {"observed_rate", "observed_rate_h1", "observed_rate_stress"})
        if (!row.get(rate).empty())
          row.set(rate, "");
      if (row.get("converged") == "true" && row.number("cell_size") > 0)
        series[key].push_back(&row);
    }
    for (auto &[key, members] : series)
    {
      std::stable_sort(members.begin(), members.end(), [](const auto *one, const auto *other) {
        return one->number("cell_size") > other->number("cell_size");
      });
      for (std::size_t i = 1; i < members.size(); ++i)
      {
        set_rate(*members[i - 1], *members[i], "relative_l2_error", "observed_rate");
        set_rate(*members[i - 1], *members[i], "relative_h1_error", "observed_rate_h1");
        set_rate(*members[i - 1], *members[i], "relative_stress_error", "observed_rate_stress");
      }
    }
  }
} // namespace softcell
