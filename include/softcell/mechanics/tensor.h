// SPDX-License-Identifier: LGPL-2.1-or-later
// A 3 x 3 matrix of any number type (double, float, a SIMD pack, an automatic-differentiation type), for host and
// device. deal.II's Tensor needs number traits that SIMD packs do not have.
#pragma once

#ifdef __CUDACC__
#  define SOFTCELL_HOST_DEVICE __host__ __device__
#else
#  define SOFTCELL_HOST_DEVICE
#endif

namespace softcell
{
  /// Aggregate of nine numbers, row by row.
  template <class Number>
  struct Matrix3
  {
    Number entries[9];

    SOFTCELL_HOST_DEVICE Number &operator()(const int i, const int j)
    {
      return entries[3 * i + j];
    }
    SOFTCELL_HOST_DEVICE const Number &operator()(const int i, const int j) const
    {
      return entries[3 * i + j];
    }
  };
} // namespace softcell
