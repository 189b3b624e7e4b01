// SPDX-License-Identifier: LGPL-2.1-or-later
// How much memory this machine has to give, and whether it is enough.
#pragma once

#include <mpi.h>

#include <string>

namespace softcell
{
  /// Memory that is free on this machine, or left below the limits of this job's control groups.
  /// Infinity where Linux does not say. Units: bytes
  double free_memory();

  /// Compares what all ranks together will need with what is free on their machines; ranks on one
  /// machine share its memory. Collective.
  /// @param shared  bytes that are spread evenly over the ranks.
  /// @param by_each bytes that every rank needs in full.
  /// @param what    of the message: the entries that ask for it.
  /// @param remedy  of the message: what mends it.
  /// @throws BadInput if it is not enough on some machine.
  void check_memory(double shared,
                    double by_each,
                    const std::string &what,
                    const std::string &remedy,
                    MPI_Comm communicator);
} // namespace softcell
