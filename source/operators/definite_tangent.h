// SPDX-License-Identifier: LGPL-2.1-or-later
// The moduli of a positive semi-definite Neo-Hookean tangent; for host and device.
#pragma once

#include <softcell/mechanics/laws.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  /// What a definite tangent has in place of the pressure lambda v, and in addition to lambda, see
  /// Tangent. Units: Pa
  template <class Number>
  struct DefiniteModuli
  {
    Number pressure, added;

    /// A part of what is added, and of mu - pressure.
    template <class Real>
    SOFTCELL_HOST_DEVICE DefiniteModuli part(const Number &share, const Real &mu) const
    {
      return {mu - share * (mu - pressure), share * added};
    }
  };

  /// With A = dF F^-1 in the principal axes and stretches s, dF : dP without lambda is the sum of
  /// mu s_j^2 A_ij^2 + f A_ij A_ji with f = mu - lambda v, which may be from -mu s_1^2 to
  /// mu s_1 s_2 with the smallest ones. In their place stand lower bounds, at least 3/4 of s_1^2
  /// and 0.86 of s_1 s_2 = J / s_3, by Laguerre's bounds of C's eigenvalues.
  template <class Real, class Number>
  SOFTCELL_HOST_DEVICE DefiniteModuli<Number>
  definite_moduli(const NeoHookean<Real> &law, const Matrix3<Number> &F, const Number &pressure)
  {
    using std::max;
    using std::min;
    using std::sqrt;
    const Real tiny(1e-37F); // where F is flat
    const Matrix3<Number> C = right_cauchy_green(F);
    const Number zero(0),
      J = determinant(F), I1 = trace(C), CC = double_contraction(C, C),
      I2       = max((I1 * I1 - CC) / 2, zero),
      smallest = 3 * J * J / (I2 + 2 * sqrt(max(I2 * I2 - 3 * I1 * J * J, zero)) + tiny),
      largest  = (I1 + 2 * sqrt(max(3 * CC - I1 * I1, zero) / 2)) / 3,
      limited =
        min(max(pressure, law.mu - law.mu * J / sqrt(largest + tiny)), law.mu + law.mu * smallest);
    return {limited, max(limited - pressure, Number(-law.lambda))};
  }

  /// f = 0 where the law is continued, as its derivatives are others there.
  template <class Real, class Number>
  SOFTCELL_HOST_DEVICE DefiniteModuli<Number> definite_moduli(const InvertibleNeoHookean<Real> &law,
                                                              const Matrix3<Number> &F,
                                                              const Number &pressure)
  {
    using std::max;
    using std::min;
    const Number share = determinant(F) / law.template smallest_regular<Number>() - Number(1);
    return definite_moduli(NeoHookean<Real>{law.lambda, law.mu}, F, pressure)
      .part(min(max(share, Number(0)), Number(1)), law.mu);
  }
} // namespace softcell
