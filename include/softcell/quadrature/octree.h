// SPDX-License-Identifier: LGPL-2.1-or-later
// Recursive halving of a box towards a body's boundary.
#pragma once

#include <softcell/geometry/body.h>

#include <cstdint>

namespace softcell
{
  /// How a box lies to the body, but for a billionth of its size at its faces: a box whose face
  /// lies in the body's boundary is not cut, whatever the rounding of its coordinates.
  inline Side side_of(const Body &body, const Box &box)
  {
    const auto &[lower, upper] = box.get_boundary_points();
    const Direction inset      = 1e-9 * (upper - lower);
    return body.classify(Box({lower + inset, upper - inset}));
  }

  /// The path from the root to a leaf: a leading 1, then three bits per halving, the lowest of them
  /// for x.
  using LeafCode = std::uint32_t;

  /// Halvings that a LeafCode has room for.
  constexpr unsigned int max_levels = 10;

  /// Halves the box at most `levels` times where the body's boundary goes and calls leaf(Box, Side,
  /// LeafCode) for each leaf. Only leaves of the last level are cut.
  template <class Leaf>
  void visit_leaves(const Body &body,
                    const Box &box,
                    const unsigned int levels,
                    const Leaf &leaf,
                    const LeafCode code = 1)
  {
    const Side side = side_of(body, box);
    if (side == Side::cut && levels > 0)
      for (unsigned int child = 0; child < 8; ++child)
        visit_leaves(body, box.child(child), levels - 1, leaf, code << 3 | child);
    else
      leaf(box, side, code);
  }
} // namespace softcell
