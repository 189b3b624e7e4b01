// SPDX-License-Identifier: LGPL-2.1-or-later
// Packs of numbers as the kernels of the matrix-free operators use them.
#pragma once

#include "simd_logarithm.h"

#include <softcell/mechanics/tensor.h>

#include <utility>

namespace softcell
{
  template <class Real>
  struct SimdNumbers
  {
    using Number                    = std::experimental::native_simd<Real>;
    static constexpr unsigned int W = Number::size();

    /// Pack `number` of an array of packs.
    static Number load(const Real *const packed, const std::size_t number)
    {
      return Number(packed + number * W, std::experimental::vector_aligned);
    }
    static void store(const Number &value, Real *const packed, const std::size_t number)
    {
      value.copy_to(packed + number * W, std::experimental::vector_aligned);
    }
    static Number log1p(const Number &x)
    {
      return simd_log1p(x);
    }
    /// Each lane's value in the next lane, and 0 in the first.
    template <class Pack>
    static Pack moved_up(const Pack &x)
    {
      if constexpr (sizeof(Pack) < 16) // no vector of the processor's
        return Pack([&](const auto lane) { return lane == 0 ? Real(0) : Real(x[lane - 1]); });
      else
        return moved_up(x, std::make_index_sequence<Pack::size()>());
    }
    /// Both halves in one pack, in registers: stdx::concat writes them to memory and waits for
    /// them.
    template <class Half>
    static Number joined(const Half &lower, const Half &upper)
    {
      if constexpr (sizeof(Half) < 16) // no vector of the processor's
        return std::experimental::concat(lower, upper);
      else
        return joined(lower, upper, std::make_index_sequence<W>());
    }
    template <class Mask>
    static unsigned int count(const Mask &mask)
    {
      return std::experimental::popcount(mask);
    }
    static void reset_where_empty(const Number &weight, Matrix3<Number> &F)
    {
#pragma GCC unroll 9
      for (int k = 0; k < 9; ++k)
        std::experimental::where(weight == 0, F.entries[k]) = Number(k % 4 == 0 ? 1 : 0);
    }

  private:
    template <class Half, std::size_t... lane>
    static Number
    joined(const Half &lower, const Half &upper, std::index_sequence<lane...> /*lanes*/)
    {
      using Lanes [[gnu::vector_size(sizeof(Half))]] = Real;
      return Number(
        __builtin_shufflevector(static_cast<Lanes>(lower), static_cast<Lanes>(upper), lane...));
    }
    template <class Pack, std::size_t... lane>
    static Pack moved_up(const Pack &x, std::index_sequence<lane...> /*lanes*/)
    {
      using Lanes [[gnu::vector_size(sizeof(Pack))]] = Real;
      return Pack(__builtin_shufflevector(Lanes{}, static_cast<Lanes>(x),
                                          (lane == 0 ? 0 : Pack::size() + lane - 1)...));
    }
  };
} // namespace softcell
