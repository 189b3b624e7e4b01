// SPDX-License-Identifier: LGPL-2.1-or-later
// The cells of a uniform grid in bricks, as the kernels of a graphics card take them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace softcell
{
  struct CellLattice;

  /// The bricks of 8 x 4 x 4 cells in which the body has cells; a thread for each cell.
  ///
  /// A brick stores nothing if all its cells are full, and otherwise eight weights a cell, which
  /// are 0 where there is no cell. Entries are those of a LatticeField.
  template <class Real>
  struct CellBricks
  {
    /// @throws BadInput if cells have points of their own.
    explicit CellBricks(const CellLattice &cells);

    static constexpr int size[3]   = {8, 4, 4}; // along x first
    static constexpr int n_cells   = 8 * 4 * 4; // of a brick
    static constexpr int n_corners = 9 * 5 * 5;

    std::size_t n_entries, row, plane; // see NodeLattice
    Real spacing[3];                   // edges of a cell. Units: m
    std::vector<int> entries;          // (bricks) of the lowest node
    std::vector<int> weight_packs;     // (bricks) number of its weights; -1 if all cells are full
    std::vector<Real> weights;         // (packs, 8, n_cells) Units: m^3

    /// What sums up at the nodes: 8 x 4 x 4 of them.
    struct NodeBrick
    {
      int entry;     // of the lowest node
      int n_rows[2]; // along y and z; nodes of these are there, if only as padding
      int bricks[8]; // the one with the same lowest node, then those before it, along x first: bit
                     // d of the place says that it is the one before along axis d; -1 if none
    };
    std::vector<NodeBrick> node_bricks;
  };
} // namespace softcell
