// SPDX-License-Identifier: LGPL-2.1-or-later
// The grids of a multigrid as a graphics card takes them.
#pragma once

#include <softcell/operators/cell_bricks.h>

#include <memory>
#include <vector>

namespace softcell
{
  struct GridLevel;

  /// What the card gets of a level.
  template <class Real>
  struct CardLevel
  {
    CellBricks<Real> bricks;
    std::array<int, 3> n_nodes;
    std::vector<unsigned char> held; // (entries) bits: components that are not free
    std::vector<Real> rough_field;   // (3, entries) see softcell::rough_field()
  };

  /// The levels of grid_levels(), which stay on the host.
  template <class Real>
  class CardLevels
  {
  public:
    CardLevels(const CellLattice &cells, const std::vector<std::size_t> &held);
    ~CardLevels();

    unsigned int size() const;
    /// @throws BadInput see CellBricks
    CardLevel<Real> level(unsigned int l) const;

    /// A displacement of a level, (3, entries), as one of the next coarser one.
    std::vector<Real> coarse(unsigned int l, const std::vector<Real> &displacement) const;

    /// Entries of the coarsest level's free unknowns.
    std::vector<int> coarsest_entries() const;

  private:
    std::unique_ptr<std::vector<GridLevel>> levels_;
  };

  /// @param matrix  (n, n) symmetric and regular but for rounding.
  std::vector<double> symmetric_inverse(const std::vector<double> &matrix);
} // namespace softcell
