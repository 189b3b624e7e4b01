// SPDX-License-Identifier: LGPL-2.1-or-later
// Everything that one parameter file asks for: a single case, or a sweep over many.
#pragma once

#include <softcell/base/console.h>

#include <string>
#include <vector>

namespace softcell
{
  /// Runs all cases of a parameter file and writes results.csv, run.json and the solutions.
  /// Collective.
  ///
  /// With a reference, every row gets the relative difference of displacement, gradient and
  /// stress to the reference's over the reference's body, or to the manufactured solution if there
  /// is one, and from the second size of a series on, the observed rates. Where sweeps change the
  /// problem itself, there is a reference for each problem.
  ///
  /// Where there is more than one run, all are built before the first is solved, so that a mistake
  /// in the last one shows at once. A case that fails all the same is a row of its own and not the
  /// end of the others. Cases and references keep what they are known by (fingerprint()) in their
  /// folders, and those that are there already are not solved again, so that a study that was
  /// interrupted goes on where it stopped.
  ///
  /// @param settings from the command line, each `Section/Entry = value`.
  /// @param is_check build everything, say how large it is, solve and write nothing.
  /// @return 0, or 2 if a case or a reference did not converge.
  /// @throws BadInput
  int run_study(const std::string &file,
                const std::vector<std::string> &settings,
                const std::vector<std::string> &command_line,
                bool is_check,
                Console &console);
} // namespace softcell
