// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of a body that hang together.
#pragma once

#include <softcell/discretization/discretization.h>

#include <vector>

namespace softcell
{
  /// Of each of this rank's nodes, its own and ghosts, the part of the body that it belongs to. Two
  /// nodes are in the same part if patches, of any rank, lead from one to the other; parts share no
  /// node and move without one another. A part has the number of its first node. Collective.
  std::vector<unsigned int> connected_parts(const Discretization &discretization);
} // namespace softcell
