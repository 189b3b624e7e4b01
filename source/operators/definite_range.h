// SPDX-License-Identifier: LGPL-2.1-or-later
// How much stress a Neo-Hookean tangent may keep to be positive semi-definite; for host and device.
#pragma once

#include <softcell/mechanics/laws.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  /// Where mu - lambda v may be, so that the tangent is positive semi-definite.
  template <class Number>
  struct DefiniteRange
  {
    Number lower, upper;
  };

  /// With A = dF F^-1 in the principal axes and stretches s, dF : dP without lambda is the sum of
  /// mu s_j^2 A_ij^2 + (mu - lambda v) A_ij A_ji: -mu s_1^2 and mu s_1 s_2 with the smallest ones.
  /// In their place stand lower bounds, at least 3/4 of s_1^2 and 0.86 of s_1 s_2 = J / s_3, by
  /// Laguerre's bounds of C's eigenvalues.
  template <class Real, class Number>
  SOFTCELL_HOST_DEVICE DefiniteRange<Number> definite_range(const NeoHookean<Real> &law,
                                                            const Matrix3<Number> &F)
  {
    using std::max;
    using std::sqrt;
    const Real tiny(1e-37F); // where F is flat
    const Matrix3<Number> C = right_cauchy_green(F);
    const Number zero(0),
      J = determinant(F), I1 = trace(C), CC = double_contraction(C, C),
      I2       = max((I1 * I1 - CC) / 2, zero),
      smallest = 3 * J * J / (I2 + 2 * sqrt(max(I2 * I2 - 3 * I1 * J * J, zero)) + tiny),
      largest  = (I1 + 2 * sqrt(max(3 * CC - I1 * I1, zero) / 2)) / 3;
    return {-law.mu * smallest, law.mu * J / sqrt(largest + tiny)};
  }

  /// 0 where the law is continued, as its derivatives are others there.
  template <class Real, class Number>
  SOFTCELL_HOST_DEVICE DefiniteRange<Number> definite_range(const InvertibleNeoHookean<Real> &law,
                                                            const Matrix3<Number> &F)
  {
    using std::max;
    using std::min;
    const Number share = determinant(F) / law.template smallest_regular<Number>() - Number(1);
    const Number kept  = min(max(share, Number(0)), Number(1));
    const auto regular = definite_range(NeoHookean<Real>{law.lambda, law.mu}, F);
    return {kept * regular.lower, kept * regular.upper};
  }
} // namespace softcell
