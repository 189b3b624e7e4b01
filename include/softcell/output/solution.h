// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements and stresses as files for ParaView.
#pragma once

#include <softcell/discretization/discretization.h>

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  class Surface;
  struct PatchAverages;

  /// Writes a history of displacements: a .vtu file for each state, under MPI one for each rank and
  /// a .pvtu that joins them, and a .pvd that lists the states by load factor or time. Cells stand
  /// in the reference configuration; ParaView's filter `Warp By Vector` deforms them.
  class SolutionWriter
  {
  public:
    /// @param stem path of the files without endings, e.g. DIR/solution
    SolutionWriter(const Discretization &discretization, std::string stem);

    /// Adds a state: point data `displacement` (m), cell data `von_mises` (Pa), `J` and
    /// `cut_fraction`. Collective. Ghosted u. @throws BadInput if the files cannot be written.
    void write(double time, const Vector &u, const PatchAverages &fields);

  private:
    MPI_Comm communicator_;
    std::string stem_;
    DrawnCells cells_;
    std::vector<std::pair<double, std::string>> states_; // time and file name without its folder
  };

  /// Writes a body's surface at its deformed place, with its displacement (m) as point data.
  /// @param displacement one per vertex.
  void write_deformed_surface(const std::string &file,
                              const Surface &surface,
                              const std::vector<Direction> &displacement);
} // namespace softcell
