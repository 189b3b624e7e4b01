// SPDX-License-Identifier: LGPL-2.1-or-later
// The inverse of a node's diagonal block, for host and device.
#pragma once

#include <softcell/mechanics/tensor.h>

namespace softcell
{
  /// Inverts a symmetric block by its cofactors; the entries are those of LatticeBlocks. A block
  /// that is not positive definite is replaced by its trace.
  SOFTCELL_HOST_DEVICE inline void invert(double (&A)[6])
  {
    const double xx = A[1] * A[2] - A[3] * A[3], xy = A[4] * A[3] - A[5] * A[2],
                 xz = A[5] * A[3] - A[4] * A[1], yy = A[0] * A[2] - A[4] * A[4],
                 zz = A[0] * A[1] - A[5] * A[5], yz = A[4] * A[5] - A[0] * A[3];
    const double determinant = A[0] * xx + A[5] * xy + A[4] * xz;
    const double trace       = A[0] + A[1] + A[2];
    const bool is_positive   = A[0] > 0 && zz > 0 && determinant > 1e-6 * zz * trace;
    const double inverse[6]  = {xx, yy, zz, yz, xz, xy};
    for (int k = 0; k < 6; ++k)
      if (is_positive)
        A[k] = inverse[k] / determinant;
      else
        A[k] = k < 3 && trace > 0 ? 1 / trace : 0;
  }

  /// The same in the components that are free, 0 in rows and columns of the others.
  template <class IsFree>
  SOFTCELL_HOST_DEVICE void invert_free(double (&A)[6], const IsFree &is_free)
  {
    double largest = A[0];
    for (int k = 1; k < 3; ++k)
      largest = A[k] > largest ? A[k] : largest;
    const auto set_held = [&](const double diagonal) {
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b)
          if (!(is_free(a) && is_free(b)))
            A[a == b ? a : 6 - a - b] = a == b ? diagonal : 0;
    };
    set_held(largest);
    invert(A);
    set_held(0);
  }
} // namespace softcell
