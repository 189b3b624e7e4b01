// SPDX-License-Identifier: LGPL-2.1-or-later
// What is done at the nodes with what bricks of cells have for them, for host and device.
#pragma once

#include <softcell/mechanics/tensor.h>
#include <softcell/operators/cell_bricks.h>

#include "cell_kernels.h"

namespace softcell
{
  /// Sums up what the bricks have for each node, and calls action(entry, sums) with
  /// Action::n_values of them.
  template <class Real, class Action>
  struct NodeKernel
  {
    using Bricks  = CellBricks<Real>;
    using Scratch = Real;

    static constexpr int n_threads = Bricks::n_cells, n_phases = 1, n_scratch = 0;

    int row, plane, n_bricks;
    const typename Bricks::NodeBrick *node_bricks;
    const Real *sums; // (n_values, bricks, n_corners)
    Action action;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, Real * /*scratch*/) const
    {
      const auto &brick = node_bricks[block];
      const int x = thread % 8, y = thread / 8 % 4, z = thread / 32;
      if (y >= brick.n_rows[0] || z >= brick.n_rows[1])
        return;
      Real values[Action::n_values] = {};
      SOFTCELL_DEVICE_UNROLL
      for (int side = 0; side < 8; ++side)
      {
        const int dx = side & 1, dy = side >> 1 & 1, dz = side >> 2, b = brick.bricks[side];
        if (b >= 0 && (dx == 0 || x == 0) && (dy == 0 || y == 0) && (dz == 0 || z == 0))
        {
          SOFTCELL_DEVICE_UNROLL
          for (int k = 0; k < Action::n_values; ++k)
            values[k] += sums[(k * std::size_t(n_bricks) + b) * Bricks::n_corners + x + 8 * dx +
                              9 * (y + 4 * dy + 5 * (z + 4 * dz))];
        }
      }
      action(std::size_t(brick.entry) + x + row * y + plane * z, values);
    }
  };

  /// Is a component of a node free?
  SOFTCELL_HOST_DEVICE inline bool
  is_free(const unsigned char *const held, const std::size_t entry, const int c)
  {
    return held == nullptr || (held[entry] >> c & 1) == 0;
  }

  /// Puts the sums into a field, 0 in the first three components where they are held.
  template <class Real, int n>
  struct StoreAction
  {
    static constexpr int n_values = n;

    std::size_t n_entries;
    const unsigned char *held; // (n_entries) bits: components; or null
    Real *field;               // (n, n_entries)

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry, const Real *const values) const
    {
      SOFTCELL_DEVICE_UNROLL
      for (int c = 0; c < n; ++c)
        field[c * n_entries + entry] = is_free(held, entry, c) ? values[c] : Real(0);
    }
  };
} // namespace softcell
