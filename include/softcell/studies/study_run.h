// SPDX-License-Identifier: LGPL-2.1-or-later
// The runs of a study, and how each is known again in the folder where it was left.
#pragma once

#include <softcell/output/results.h>
#include <softcell/output/run_record.h>
#include <softcell/procedures/parameters.h>
#include <softcell/studies/time_left.h>

#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// A case or a reference.
  struct StudyRun
  {
    std::string name;
    Parameters parameters;
    std::string fingerprint; // on rank 0
    ResultsRow row;          // of results.csv, empty until it is solved
    std::vector<double> linear_residuals;
    Work work; // once it is built

    bool is_solved() const
    {
      return !row.values().empty();
    }
  };

  struct CaseRun : StudyRun
  {
    std::vector<std::pair<std::string, std::string>> labels; // name and label of each sweep
    unsigned int reference = 0;                              // which one it is measured against
  };

  /// The cases of a parameter file, those of the same reference together, and the references.
  /// @param settings from the command line, each `Section/Entry = value`.
  /// @throws BadInput
  std::pair<std::vector<CaseRun>, std::vector<StudyRun>>
  study_runs(const std::string &file,
             const std::vector<std::string> &settings,
             const Parameters &parameters);

  /// Does a run take its loads from the reference?
  /// @throws BadInput for loads that cannot be read.
  bool imposes_reference(const Parameters &parameters);

  /// By which the time of a run is guessed from that of others.
  Work work_of(const Parameters &parameters, double points, double unknowns);

  /// The time of a run, and of finding its errors where there are some. Units: s
  double seconds_of(const ResultsRow &row);

  /// The entries of a run that its results depend on: all but those of the study as a whole.
  std::vector<ParameterFile::Entry> own_entries(const Parameters &parameters);

  /// Gives a run its fingerprint, and the row and residuals that keep() left in the folder if they
  /// have the same one. Collective.
  /// @param folder    empty: nothing is looked for.
  /// @param reference fingerprint of what its errors are measured against.
  void recall(StudyRun &run,
              const std::filesystem::path &folder,
              unsigned int n_ranks,
              const std::string &reference);

  /// What a user should read of an error that ended a run.
  std::string reason_of(const std::exception &error);

  /// The row of a run that threw; without a fingerprint, so that it is tried again.
  ResultsRow failed_row(const StudyRun &run, const std::string &reason);

  /// Leaves the row and the record of a run in its folder, as the last that it writes. Collective.
  /// @param record of the study.
  /// @throws BadInput if they cannot be written.
  void keep(const StudyRun &run, const std::filesystem::path &folder, RunRecord record);
} // namespace softcell
