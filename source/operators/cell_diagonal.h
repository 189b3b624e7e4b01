// SPDX-License-Identifier: LGPL-2.1-or-later
// The diagonal blocks of one cell's tangent, or of a pack of cells; for host and device.
#pragma once

#include "cell_kernels.h"

namespace softcell
{
  /// The derivatives of a corner's shape at a point.
  template <class Number, class Real, class AnyPoint>
  SOFTCELL_HOST_DEVICE void corner_gradient(const AnyPoint &point,
                                            const int corner,
                                            const Real *const scale,
                                            Number *const gradient)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[axis] = Number((corner >> axis) & 1 ? scale[axis] : -scale[axis]);
      for (int step = 1; step < 3; ++step)
      {
        const int other = (axis + step) % 3;
        const Real sign = (corner >> other) & 1 ? 1 : -1;
        gradient[axis] *= Real(1) + sign * Number(point.place(other));
      }
    }
  }

  /// Adds the diagonal blocks of the tangent at u, symmetric, in the order of LatticeBlocks.
  /// @param K  K[entry of the block][corner].
  template <class Cells, class Law, class Real, class Blocks>
  SOFTCELL_HOST_DEVICE void add_corner_blocks(const Cells &cells,
                                              const Law &law,
                                              const CellGeometry<Real> &geometry,
                                              const Components<const Real> &u,
                                              const PointModuli<const Real> &moduli,
                                              Blocks &K)
  {
    using Number = typename Cells::Number;
    for_each_tangent(cells, law, geometry, u, moduli, [&](const auto &point, const auto &tangent) {
      for (int corner = 0; corner < 8; ++corner)
      {
        NodalGradient<Number> dF;
        corner_gradient(point, corner, geometry.scale, dF.gradient);
        SOFTCELL_DEVICE_UNROLL
        for (int b = 0; b < 3; ++b)
        {
          dF.component             = b;
          const Matrix3<Number> dP = tangent(dF);
          SOFTCELL_DEVICE_UNROLL
          for (int a = 0; a <= b; ++a)
            K[a == b ? a : 6 - a - b][corner] += dot(dP, a, dF.gradient);
        }
      }
    });
  }

  /// The same at the nodes.
  template <class Cells, class Law, class Real>
  SOFTCELL_FLATTEN void add_diagonal(const Cells &cells,
                                     const Law &law,
                                     const CellGeometry<Real> &geometry,
                                     const Components<const Real> &u,
                                     const PointModuli<const Real> &moduli,
                                     Real *const (&blocks)[6])
  {
    Corners<typename Cells::Number> K[6] = {};
    add_corner_blocks(cells, law, geometry, u, moduli, K);
    for (int k = 0; k < 6; ++k)
      cells.add(K[k], blocks[k]);
  }
} // namespace softcell
