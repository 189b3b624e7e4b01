// SPDX-License-Identifier: LGPL-2.1-or-later
// The grids of a multigrid.
#pragma once

#include <softcell/operators/lattice_unknowns.h>

#include <vector>

namespace softcell
{
  struct GridLevel
  {
    CellLattice cells;
    LatticeUnknowns unknowns;
  };

  /// A grid of cells and those with twice, four times, ... the edges, up to one with so few
  /// unknowns that it can be solved exactly.
  /// @param held  entries of a LatticeVector whose unknowns are not free.
  std::vector<GridLevel> grid_levels(const CellLattice &cells,
                                     const std::vector<std::size_t> &held);

  /// A displacement of a level as one of the next coarser one, smoothed where coarse cells are
  /// nearly inside out.
  template <class Real>
  LatticeVector<Real> coarse_displacement(const LatticeUnknowns &fine,
                                          const LatticeVector<Real> &u,
                                          const LatticeUnknowns &coarse,
                                          const Direction &coarse_spacing);

  /// Numbers between -1/2 and 1/2 that look random: with a share in every eigenvector of an
  /// operator.
  template <class Real>
  LatticeVector<Real> rough_field(const LatticeUnknowns &unknowns, unsigned int seed = 1);
} // namespace softcell
