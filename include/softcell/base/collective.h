// SPDX-License-Identifier: LGPL-2.1-or-later
// Failures of one rank that all ranks hear of, so that none waits for ever.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>

namespace softcell
{
  /// Throws BadInput on all ranks if any rank complains: the first complaint that is not empty.
  /// Collective.
  void throw_on_all(MPI_Comm communicator, const std::string &complaint);

  /// Runs `act`, which may not communicate, on all ranks. If it throws BadInput on any, all ranks
  /// throw that. Collective.
  void on_all(MPI_Comm communicator, const std::function<void()> &act);

  /// The same with an `act` that only rank 0 runs. Collective.
  void on_root(MPI_Comm communicator, const std::function<void()> &act);
} // namespace softcell
