// SPDX-License-Identifier: LGPL-2.1-or-later
// FlatPatches as plain arrays, for the kernels of a graphics card.
#pragma once

#include <cstddef>
#include <vector>

namespace softcell
{
  /// Width of the batches for graphics cards: the threads of a warp.
  constexpr int card_width = 32;

  /// PaddedRows.
  template <class Real>
  struct RowArrays
  {
    std::size_t n_batches;
    const unsigned int *starts;  // (n_batches + 1) first pack of a batch
    const unsigned int *lengths; // (n_batches) of the longest row
    const unsigned int *numbers; // (packs, width)
    const Real *gradients;       // (packs, 3, width) Units: 1/m
  };

  template <class Real>
  struct FlatArrays
  {
    unsigned int width, n_nodes;
    RowArrays<Real> points;     // rows of nodes
    RowArrays<Real> nodes;      // rows of points
    const Real *weights;        // (n_batches of points, width) Units: m^3
    const unsigned int *labels; // (n_batches of points)
  };

  /// Rows that have changed, packed one after another to be sent at once.
  template <class Real>
  struct RowChanges
  {
    struct Row
    {
      std::size_t row, first; // its number; its batch's first pack
      unsigned int length;    // of the batch's longest row
      unsigned int room;      // entries that are sent
      unsigned int offset;    // of the first in `numbers`
      bool is_point;          // or a node
      Real weight;            // of a point
    };
    std::vector<Row> rows;
    std::vector<unsigned int> numbers; // (entries)
    std::vector<Real> gradients;       // (entries, 3)
  };
} // namespace softcell
