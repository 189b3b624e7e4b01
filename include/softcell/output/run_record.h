// SPDX-License-Identifier: LGPL-2.1-or-later
// run.json: what was run, with what, where and for how long.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// What the program knows of a run; version, commit, libraries and host are added when it is
  /// written.
  struct RunRecord
  {
    std::string command_line;
    std::string status = "running"; // done, not converged, failed
    std::string message;            // why, where it is not done
    unsigned int ranks = 1;
    double wall_s      = 0;
    std::vector<std::pair<std::string, std::string>> parameters; // Section/Entry and value
    std::vector<std::string> remarks;                            // what was repaired or assumed
    std::vector<std::pair<std::string, std::vector<double>>>
      linear_residuals; // of each case's last linear system, relative, after each iteration
  };

  /// The record as JSON text.
  std::string json(const RunRecord &record);

  /// Writes the record into the file; call it at the start and again at the end, on rank 0.
  void write_run_record(const std::string &file, const RunRecord &record);

  /// Writes the record of a run that failed on this rank, unless another rank's failure is there;
  /// of those at the same moment any one stays. Not collective, and throws nothing.
  void write_failure(const std::string &file, const RunRecord &record);

  /// The linear residuals of the first case of a record that was written; none if it cannot be
  /// read.
  std::vector<double> read_linear_residuals(const std::string &file);
} // namespace softcell
