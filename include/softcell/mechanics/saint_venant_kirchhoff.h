// SPDX-License-Identifier: LGPL-2.1-or-later
// The law of Saint-Venant and Kirchhoff; what a law offers is told in laws.h.
#pragma once

#include <softcell/mechanics/hyperelastic.h>

namespace softcell
{
  /// W = lambda/2 (tr E)^2 + mu E : E (Brunet eq. 2.8). It has a value for J <= 0 too, but one that
  /// resists no inversion, so that is refused.
  template <class Real = double>
  struct SaintVenantKirchhoff : Hyperelastic<SaintVenantKirchhoff, Real>
  {
    using Base = Hyperelastic<softcell::SaintVenantKirchhoff, Real>;
    using Base::first_piola_stress, Base::linearisation, Base::lambda, Base::mu;

    template <class Number>
    SOFTCELL_HOST_DEVICE static auto is_admissible(const Number &J)
    {
      return J > Number(0);
    }

    /// tr E
    template <class Number>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F)
    {
      return trace(green_lagrange_strain(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Matrix3<Number> volumetric_gradient(const Matrix3<Number> &F)
    {
      return F;
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Number energy(const Matrix3<Number> &F) const
    {
      const Matrix3<Number> E = green_lagrange_strain(F);
      const Number tr_E       = trace(E);
      return lambda / 2 * tr_E * tr_E + mu * double_contraction(E, E);
    }

    /// S = F^-1 P.
    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> second_piola_stress(const Matrix3<Number> &F,
                                                             const Number &pressure) const
    {
      return pressure * identity<Number>() + 2 * mu * green_lagrange_strain(F);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> first_piola_stress(const Matrix3<Number> &F,
                                                            const Number &pressure) const
    {
      return F * second_piola_stress(F, pressure);
    }

    /// dP = dF S + F dS, dS = lambda tr(dE) I + 2 mu dE, dE = sym(F^T dF).
    template <class Number>
    struct Linearisation
    {
      Real mu, lambda;
      Matrix3<Number> F, S, FFt;

      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const Matrix3<Change> &dF) const
      {
        const Matrix3<Change> FtdF     = transpose(F) * dF;
        const Change pressure          = lambda * trace(FtdF);
        const Matrix3<Change> twice_dE = FtdF + transpose(FtdF);
        return dF * S + pressure * F + mu * (F * twice_dE);
      }

      /// With g = dN/dX and its push forward q = F g, row a of dP is
      /// delta_ab S g + lambda q_b F_a + mu (q_a F_b + (F F^T)_ab g).
      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const NodalGradient<Change> &dF) const
      {
        const int b = dF.component;
        Matrix3<Change> dP;
        const Change q_b = lambda * dot(F, b, dF.gradient);
        for (int a = 0; a < 3; ++a)
        {
          const Change q_a = mu * dot(F, a, dF.gradient);
          const Number c   = mu * FFt(a, b);
          for (int A = 0; A < 3; ++A)
            dP(a, A) = q_b * F(a, A) + q_a * F(b, A) + c * dF.gradient[A];
        }
        for (int A = 0; A < 3; ++A)
          dP(b, A) += dot(S, A, dF.gradient);
        return dP;
      }
    };

    template <class Number>
    SOFTCELL_HOST_DEVICE Linearisation<Number> linearisation(const Matrix3<Number> &F,
                                                             const Number &pressure) const
    {
      return {mu, Real(0), F, second_piola_stress(F, pressure), F * transpose(F)};
    }
  };
} // namespace softcell
