// SPDX-License-Identifier: LGPL-2.1-or-later
// The logarithm of a pack, for which the library calls a function lane by lane.
#pragma once

#include <experimental/simd>
#include <limits>

namespace softcell
{
  /// ln(1 + x) to a few units in the last place, also for small x; NaN for x < -1.
  ///
  /// With 1 + x = 2^e (1 + f), sqrt(1/2) <= 1 + f < sqrt(2), and s = f / (2 + f), ln(1 + f) is
  /// 2 artanh s = 2 (s + s^3/3 + s^5/5 + ...), |s| <= 0.172.
  template <class Real, class Abi>
  std::experimental::simd<Real, Abi> simd_log1p(const std::experimental::simd<Real, Abi> &x)
  {
    namespace stdx        = std::experimental;
    using Pack            = stdx::simd<Real, Abi>;
    constexpr int n_terms = sizeof(Real) == 8 ? 10 : 5; // s^2n < epsilon

    const Pack u         = Real(1) + x;
    const Pack remainder = (x - (u - Real(1))) / u; // what u has lost of x
    stdx::fixed_size_simd<int, Pack::size()> exponent;
    Pack m = stdx::frexp(u, &exponent), e = stdx::static_simd_cast<Pack>(exponent);
    const auto is_low      = m < Real(0.70710678118654752440L);
    stdx::where(is_low, m) = m + m;
    stdx::where(is_low, e) = e - Real(1);
    const Pack f = m - Real(1), s = f / (f + Real(2)), z = s * s;
    Pack series = Real(2) / Real(2 * n_terms + 1);
#pragma GCC unroll 10
    for (int n = n_terms - 1; n > 0; --n)
      series = series * z + Real(2) / Real(2 * n + 1);
    // 2 s = f - s f, which keeps the digits of f
    Pack result = e * Real(0.69314718055994530942L) + (f - s * (f - z * series) + remainder);
    stdx::where(!(u >= Real(0)), result) = std::numeric_limits<Real>::quiet_NaN();
    return result;
  }
} // namespace softcell
