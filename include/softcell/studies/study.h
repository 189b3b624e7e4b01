// SPDX-License-Identifier: LGPL-2.1-or-later
// Everything that one parameter file asks for: a single case, or a sweep over many.
#pragma once

#include <softcell/base/console.h>
#include <softcell/procedures/parameters.h>

#include <string>
#include <vector>

namespace softcell
{
  /// One run of a study: the settings that tell it from the others.
  struct StudyCase
  {
    std::string name; // finite_cell_p1_n8_l3
    std::vector<std::string> settings;
  };

  /// The cases of section Study: all combinations, with cut levels only for the methods that have
  /// them. A study of nothing has one case, named after its method.
  /// @throws BadInput if two are the same.
  std::vector<StudyCase> study_cases(const Parameters &parameters);

  /// Runs all cases of a parameter file and writes results.csv, run.json and the solutions.
  /// Collective.
  ///
  /// With a reference, every row gets the relative L2 and H1 difference to the reference's
  /// displacement over the reference's body, and from the second size of a method on, the observed
  /// rate of the first. Where there is more than one run, all are built before the first is solved,
  /// so that a mistake in the last one shows at once.
  ///
  /// @param settings from the command line, each `Section/Entry = value`.
  /// @param is_check build everything, say how large it is, solve and write nothing.
  /// @return 0, or 2 if a case did not converge.
  /// @throws BadInput
  int run_study(const std::string &file,
                const std::vector<std::string> &settings,
                const std::vector<std::string> &command_line,
                bool is_check,
                Console &console);
} // namespace softcell
