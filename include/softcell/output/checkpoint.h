// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement of a run as an HDF5 file, to go on from or to read elsewhere.
#pragma once

#include <softcell/discretization/discretization.h>

#include <string>

namespace softcell
{
  /// Writes the data sets `positions` (n, 3) and `displacement` (n, 3) of all nodes, in m, and the
  /// attribute `load_factor`. Rank 0 gathers and writes. Collective.
  void write_checkpoint(const std::string &file,
                        const Discretization &discretization,
                        const Vector &u,
                        double load_factor);

  /// Fills u, ghosts too, from a checkpoint of the same discretization on any number of ranks;
  /// nodes are told by their positions. Returns the load factor. Collective.
  /// @throws BadInput if the file cannot be read or lacks a node.
  double read_checkpoint(const std::string &file, const Discretization &discretization, Vector &u);
} // namespace softcell
