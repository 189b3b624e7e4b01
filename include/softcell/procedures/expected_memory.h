// SPDX-License-Identifier: LGPL-2.1-or-later
// How much memory a run will take, before anything is built.
#pragma once

#include <softcell/discretization/expected_size.h>
#include <softcell/procedures/parameters.h>

namespace softcell
{
  /// Bytes of memory that a run takes beside the program itself.
  struct ExpectedMemory
  {
    double shared  = 0; // by all ranks together
    double by_each = 0; // by every rank
  };

  /// By the bytes that the discretization's parts, the tangent and the linear solver were measured
  /// to take; within about a third. With a ghost penalty up to 45 % more was seen. What `Refinement
  /// steps` add is left out, since it is not known before a solution is.
  ExpectedMemory expected_memory(const Parameters &parameters, const ExpectedSize &size);

  /// @throws BadInput if a machine has not that much left. Collective.
  void check_memory(const Parameters &parameters, const Body &body, MPI_Comm communicator);
} // namespace softcell
