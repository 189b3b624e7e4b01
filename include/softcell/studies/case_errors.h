// SPDX-License-Identifier: LGPL-2.1-or-later
// What results.csv says of the error of a case.
#pragma once

#include <softcell/procedures/simulation.h>

namespace softcell
{
  /// Adds the columns of errors, and their time to the simulation's, against the manufactured
  /// solution or else against the reference. Collective.
  /// @param reference solved; may be null if there is a manufactured solution.
  /// @return a warning if the errors leave out a part of the reference's volume, since no cell is
  ///         near; else empty.
  std::string add_errors(Simulation &simulation, const Simulation *reference, ResultsRow &row);
} // namespace softcell
