// SPDX-License-Identifier: LGPL-2.1-or-later
// results.csv: one row for every solved case.

#include <softcell/output/results.h>

#include <softcell/base/files.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
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
    const std::vector<std::string> further_columns  = {"load_factor",
                                                       "time",
                                                       "time_steps",
                                                       "slowest_step_ms",
                                                       "late_steps",
                                                       "shortened_steps",
                                                       "unsolved_steps",
                                                       "largest_linear_residual",
                                                       "kinetic_energy",
                                                       "most_linear_iterations",
                                                       "cell_size",
                                                       "smallest_cut",
                                                       "unfitted_cells",
                                                       "load_energy",
                                                       "stabilization_energy",
                                                       "condition",
                                                       "refinement_steps",
                                                       "estimated_error",
                                                       "relative_l2_error",
                                                       "relative_h1_error",
                                                       "relative_stress_error",
                                                       "mean_surface_error",
                                                       "max_surface_error",
                                                       "errors_s",
                                                       "observed_rate",
                                                       "observed_rate_h1",
                                                       "observed_rate_stress",
                                                       "failure",
                                                       "fingerprint"};

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
    /// The cells of a table, line by line; the reverse of line() and csv_cell().
    std::vector<std::vector<std::string>> csv_cells(std::istream &in)
    {
      std::vector<std::vector<std::string>> lines;
      bool is_quoted = false, begins_line = true;
      for (char c; in.get(c);)
      {
        if (begins_line)
          lines.push_back({""});
        begins_line = !is_quoted && c == '\n';
        if (c == '"' && is_quoted && in.peek() == '"')
          lines.back().back() += static_cast<char>(in.get());
        else if (c == '"')
          is_quoted = !is_quoted;
        else if (c == ',' && !is_quoted)
          lines.back().emplace_back();
        else if (!begins_line)
          lines.back().back() += c;
      }
      return lines;
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

  std::vector<std::string> results_columns()
  {
    std::vector<std::string> columns = standard_columns;
    columns.insert(columns.end(), further_columns.begin(), further_columns.end());
    return columns;
  }

  void write_results(const std::string &file, const std::vector<ResultsRow> &rows)
  {
    std::vector<std::string> columns = standard_columns;
    for (const ResultsRow &row : rows)
      for (const auto &entry : row.values())
        if (std::find(columns.begin(), columns.end(), entry.first) == columns.end())
          columns.push_back(entry.first);

    std::string text = line(columns);
    for (const ResultsRow &row : rows)
    {
      std::vector<std::string> cells;
      for (const std::string &column : columns)
        cells.push_back(row.get(column));
      text += line(cells);
    }
    write_file(file, text);
  }

  std::vector<ResultsRow> read_results(const std::string &file)
  {
    std::ifstream in(file, std::ios::binary);
    const std::vector<std::vector<std::string>> lines = csv_cells(in);
    std::vector<ResultsRow> rows;
    for (std::size_t i = 1; i < lines.size(); ++i)
    {
      rows.emplace_back();
      for (std::size_t k = 0; k < std::min(lines[0].size(), lines[i].size()); ++k)
        if (!lines[i][k].empty())
          rows.back().set(lines[0][k], lines[i][k]);
    }
    return rows;
  }
} // namespace softcell
