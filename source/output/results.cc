// SPDX-License-Identifier: LGPL-2.1-or-later
// results.csv: one row for every solved case.

#include <softcell/output/results.h>

#include <softcell/base/files.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>

namespace softcell
{
  namespace
  {
    const std::vector<std::string> standard_columns = {"case",
                                                       "method",
                                                       "degree",
                                                       "cut_levels",
                                                       "cells",
                                                       "cut_cells",
                                                       "dofs",
                                                       "integration_points",
                                                       "load_steps",
                                                       "newton_iterations",
                                                       "linear_iterations",
                                                       "setup_s",
                                                       "assembly_s",
                                                       "solve_s",
                                                       "total_s",
                                                       "peak_rss_mib",
                                                       "volume",
                                                       "strain_energy",
                                                       "l2_displacement",
                                                       "min_jacobian",
                                                       "converged"};

    std::string csv_cell(const std::string &text)
    {
      if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
      std::string result = "\"";
      for (const char c : text)
        result += c == '"' ? std::string("\"\"") : std::string(1, c);
      return result + '"';
    }

    std::string line(const std::vector<std::string> &cells)
    {
      std::string text;
      for (std::size_t i = 0; i < cells.size(); ++i)
        text += (i == 0 ? "" : ",") + csv_cell(cells[i]);
      return text + '\n';
    }
  } // namespace

  void ResultsRow::set(const std::string &column, const std::string &value)
  {
    const auto old = std::find_if(values_.begin(), values_.end(),
                                  [&](const auto &entry) { return entry.first == column; });
    if (old == values_.end())
      values_.emplace_back(column, value);
    else
      old->second = value;
  }

  void ResultsRow::set(const std::string &column, const double value)
  {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    set(column, std::string(text, end));
  }

  std::string ResultsRow::get(const std::string &column) const
  {
    for (const auto &[name, value] : values_)
      if (name == column)
        return value;
    return "";
  }

  double ResultsRow::number(const std::string &column) const
  {
    const std::string text = get(column);
    char *end              = nullptr;
    const double value     = std::strtod(text.c_str(), &end);
    return text.empty() || *end != '\0' ? std::numeric_limits<double>::quiet_NaN() : value;
  }

  ResultsTable::ResultsTable(std::string file) : file_(std::move(file)) {}

  void ResultsTable::add(ResultsRow row)
  {
    rows_.push_back(std::move(row));
    if (file_.empty())
      return;
    std::vector<std::string> columns = standard_columns;
    for (const ResultsRow &each : rows_)
      for (const auto &entry : each.values())
        if (std::find(columns.begin(), columns.end(), entry.first) == columns.end())
          columns.push_back(entry.first);

    std::string text = line(columns);
    for (const ResultsRow &each : rows_)
    {
      std::vector<std::string> cells;
      for (const std::string &column : columns)
        cells.push_back(each.get(column));
      text += line(cells);
    }
    write_file(file_, text);
  }
} // namespace softcell
