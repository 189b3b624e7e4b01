// SPDX-License-Identifier: LGPL-2.1-or-later
// The Neo-Hookean law, continued to bodies that are squeezed flat and turned inside out; what a law
// offers is told in laws.h.
#pragma once

#include <softcell/mechanics/neo_hookean.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  /// W = mu/2 (tr C - 3) - mu L + lambda/2 L^2, where L is ln J for J >= J_0 and below, also for
  /// J <= 0, its quadratic Taylor polynomial at J_0.
  ///
  /// So W has two continuous derivatives, and with J falling below J_0 it rises ever faster: what
  /// is turned inside out returns, but for a point where all of F is 0.
  template <class Real = double>
  struct InvertibleNeoHookean : NeoHookeanStress<InvertibleNeoHookean, Real>
  {
    using Base = NeoHookeanStress<softcell::InvertibleNeoHookean, Real>;
    using Base::linearisation, Base::lambda, Base::mu;

    /// J_0: a body is rarely squeezed so far without being pierced.
    template <class Number>
    SOFTCELL_HOST_DEVICE static Number smallest_regular()
    {
      return Number(1) / Number(5);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static auto is_admissible(const Number &J)
    {
      return J == J;
    }

    /// L, with another function for ln(1 + x).
    template <class Number, class Log1p>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F,
                                                         const Log1p &log1p)
    {
      using std::max;
      const Number change  = volume_change(F),
                   regular = max(change, smallest_regular<Number>() - Number(1)),
                   below   = (change - regular) / (Number(1) + regular);
      return log1p(regular) + below - below * below / Number(2);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F)
    {
      return volumetric_strain(F, [](const Number &x) {
        using std::log1p;
        return log1p(x);
      });
    }

    /// dL/dJ and its derivative.
    template <class Number>
    SOFTCELL_HOST_DEVICE static void derivatives(const Number &J, Number &slope, Number &curvature)
    {
      using std::max;
      using std::min;
      const Number s = Number(1) / max(J, smallest_regular<Number>());
      slope          = s * (Number(2) - min(s * J, Number(1)));
      curvature      = -s * s;
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Matrix3<Number> volumetric_gradient(const Matrix3<Number> &F)
    {
      Number slope, curvature;
      derivatives(determinant(F), slope, curvature);
      return slope * cofactor(F);
    }

    /// With G = cof F = dJ/dF,
    /// dP = mu dF + (lambda L'^2 - (mu - lambda L) L'') (G : dF) G - (mu - lambda L) L' dG.
    template <class Number>
    struct Linearisation
    {
      Real mu;
      Number lambda, factor; // mu - lambda L
      Matrix3<Number> F, G;
      Number slope, curvature; // L', L''

      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const Matrix3<Change> &dF) const
      {
        const Change along       = stiffness() * double_contraction(G, dF);
        const Number minus       = -factor * slope;
        const Matrix3<Change> dG = cofactor_change(F, dF);
        return mu * dF + along * G + minus * dG;
      }

      /// Of row b of F alone: cofactors are cross products of two rows.
      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const NodalGradient<Change> &dF) const
      {
        const int b        = dF.component;
        const Change along = stiffness() * dot(G, b, dF.gradient);
        const Number share = factor * slope;
        Matrix3<Change> dP;
        for (int A = 0; A < 3; ++A)
        {
          const int B = (A + 1) % 3, C = (A + 2) % 3;
          for (int a = 0; a < 3; ++a)
            dP(a, A) = along * G(a, A);
          dP(b, A) += mu * dF.gradient[A];
          const int next = (b + 1) % 3, last = (b + 2) % 3;
          dP(next, A) -= share * (F(last, B) * dF.gradient[C] - F(last, C) * dF.gradient[B]);
          dP(last, A) += share * (F(next, B) * dF.gradient[C] - F(next, C) * dF.gradient[B]);
        }
        return dP;
      }

    private:
      SOFTCELL_HOST_DEVICE auto stiffness() const
      {
        return lambda * slope * slope - factor * curvature;
      }
    };

    template <class Number>
    SOFTCELL_HOST_DEVICE Linearisation<Number> linearisation(const Matrix3<Number> &F,
                                                             const Number &pressure) const
    {
      Linearisation<Number> tangent{mu, Number(0), mu - pressure, F, cofactor(F), {}, {}};
      derivatives(dot(F, 0, tangent.G.entries), tangent.slope, tangent.curvature);
      return tangent;
    }
  };
} // namespace softcell
