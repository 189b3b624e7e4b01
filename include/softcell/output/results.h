// SPDX-License-Identifier: LGPL-2.1-or-later
// results.csv: one row for every solved case.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace softcell
{
  /// One case: values by column name. Doubles are written with the fewest digits that read back the
  /// same.
  class ResultsRow
  {
  public:
    /// Sets or replaces a value.
    void set(const std::string &column, const std::string &value);
    void set(const std::string &column, double value);
    template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
    void set(const std::string &column, const Integer value)
    {
      set(column, std::to_string(value));
    }
    void set(const std::string &column, const char *value)
    {
      set(column, std::string(value));
    }
    void set(const std::string &column, const bool value)
    {
      set(column, std::string(value ? "true" : "false"));
    }

    /// Empty if the row has no such column.
    std::string get(const std::string &column) const;
    /// NaN if the row has no such column or no number there.
    double number(const std::string &column) const;

    const std::vector<std::pair<std::string, std::string>> &values() const
    {
      return values_;
    }

  private:
    std::vector<std::pair<std::string, std::string>> values_;
  };

  /// The columns that every row has, in their order, and then those that only some runs bring
  /// beside the ones named after probes, regions and sweeps.
  std::vector<std::string> results_columns();

  /// Writes rows as a table: first the columns that every run has, then all others in the order in
  /// which rows bring them. Where a row has no value the cell is empty. A run that is killed leaves
  /// a whole file.
  /// @throws BadInput if the file cannot be written.
  void write_results(const std::string &file, const std::vector<ResultsRow> &rows);

  /// Reads what write_results() wrote; rows have no value where a cell is empty. No rows if there
  /// is no such file.
  std::vector<ResultsRow> read_results(const std::string &file);
} // namespace softcell
