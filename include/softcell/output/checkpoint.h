// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement of a run as an HDF5 file, to go on from or to read elsewhere.
#pragma once

#include <softcell/discretization/background_grid.h>
#include <softcell/discretization/discretization.h>

#include <string>

namespace softcell
{
  /// Writes the data sets `positions` (n, 3) and `displacement` (n, 3) of all nodes, in m, and
  /// `load_factor`; and `refinement` (n, 4), where a background grid was refined: the round and a
  /// point in m. Rank 0 gathers and writes; a file that stood there stays until all is written.
  /// Collective. @throws BadInput if it cannot be written.
  void write_checkpoint(const std::string &file,
                        const Discretization &discretization,
                        const Vector &u,
                        double load_factor,
                        const Refinement &refinement = {});

  /// How the grid of a checkpoint was refined. Collective. @throws BadInput as read_checkpoint().
  Refinement read_refinement(const std::string &file, MPI_Comm communicator);

  /// Fills u, ghosts too, from a checkpoint that any number of ranks wrote of the same
  /// discretization, or of one that has all of its nodes; these are told by their positions.
  /// Returns the load factor. Collective. @throws BadInput if the file cannot be read, holds what
  /// is no number or no round of refinement, or lacks a node.
  double read_checkpoint(const std::string &file, const Discretization &discretization, Vector &u);
} // namespace softcell
