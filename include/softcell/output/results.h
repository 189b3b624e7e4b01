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

  /// The rows of a run. The columns that every run has come first in a fixed order, then all others
  /// in the order in which rows brought them; where a row has no value the cell is empty.
  class ResultsTable
  {
  public:
    /// @param file empty: nothing is written, for the ranks that only keep the rows.
    explicit ResultsTable(std::string file);

    /// Adds a row and writes the table anew, so that a run that is killed leaves a whole file.
    /// @throws BadInput if the file cannot be written.
    void add(ResultsRow row);

  private:
    std::string file_;
    std::vector<ResultsRow> rows_;
  };
} // namespace softcell
