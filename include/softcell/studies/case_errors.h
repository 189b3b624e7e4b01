// SPDX-License-Identifier: LGPL-2.1-or-later
// What results.csv says of the error of a case.
#pragma once

#include <softcell/procedures/simulation.h>

namespace softcell
{
  /// Adds the columns of errors against the manufactured solution or else against the reference.
  /// Collective.
  /// @param reference solved; may be null if there is a manufactured solution.
  /// @return the fraction of the reference's volume that the errors leave out, since no cell is
  ///         near.
  double add_errors(const Simulation &simulation, const Simulation *reference, ResultsRow &row);
} // namespace softcell
