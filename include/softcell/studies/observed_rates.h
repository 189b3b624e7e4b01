// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast errors fall from one size of cells to the next.
#pragma once

#include <softcell/output/results.h>

#include <string>
#include <vector>

namespace softcell
{
  /// Fills `observed_rate`, `observed_rate_h1` and `observed_rate_stress`: the order in `cell_size`
  /// at which `relative_l2_error`, `relative_h1_error` and `relative_stress_error` fell since the
  /// next larger cells of the same series. Rows of a series have the same method, degree, cut
  /// levels and values in `columns`; those that did not converge are left out.
  void add_observed_rates(std::vector<ResultsRow> &rows, const std::vector<std::string> &columns);
} // namespace softcell
