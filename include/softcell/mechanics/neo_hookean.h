// SPDX-License-Identifier: LGPL-2.1-or-later
// The compressible Neo-Hookean law; what a law offers is told in laws.h.
#pragma once

#include <softcell/mechanics/hyperelastic.h>

#include <cmath>

namespace softcell
{
  /// Of Law<Real>, a law derived from this, with W = mu/2 (tr C - 3) - mu v + lambda/2 v^2.
  template <template <class> class Law, class Real>
  struct NeoHookeanStress : Hyperelastic<Law, Real>
  {
    using Base = Hyperelastic<Law, Real>;
    using Base::first_piola_stress, Base::lambda, Base::mu;

    /// @param v  the volumetric strain at F.
    template <class Number>
    SOFTCELL_HOST_DEVICE Number energy(const Matrix3<Number> &F, const Number &v) const
    {
      return mu * (trace(green_lagrange_strain(F)) - v) + lambda / 2 * v * v;
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Number energy(const Matrix3<Number> &F) const
    {
      return energy(F, Law<Real>::volumetric_strain(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> first_piola_stress(const Matrix3<Number> &F,
                                                            const Number &pressure) const
    {
      const Number factor = pressure - mu;
      return mu * F + factor * Law<Real>::volumetric_gradient(F);
    }
  };

  /// W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2 (Brunet eq. 2.9), for J > 0.
  template <class Real = double>
  struct NeoHookean : NeoHookeanStress<NeoHookean, Real>
  {
    using Base = NeoHookeanStress<softcell::NeoHookean, Real>;
    using Base::linearisation, Base::lambda, Base::mu;

    template <class Number>
    SOFTCELL_HOST_DEVICE static auto is_admissible(const Number &J)
    {
      return J > Number(0);
    }

    /// ln J, with another function for ln(1 + x).
    template <class Number, class Log1p>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F,
                                                         const Log1p &log1p)
    {
      return log1p(volume_change(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F)
    {
      using std::log1p;
      return log1p(volume_change(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Matrix3<Number> volumetric_gradient(const Matrix3<Number> &F)
    {
      return transpose(inverse(F));
    }

    /// dP = mu dF + ((mu - lambda ln J) G dF^T G + lambda (G : dF) G) / J^2, with G = cof F.
    template <class Number>
    struct Linearisation
    {
      Real mu;
      Number lambda, factor; // mu - lambda ln J
      Matrix3<Number> G;
      Number share; // 1 / J^2

      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const Matrix3<Change> &dF) const
      {
        const Matrix3<Change> B = transpose(dF) * G; // of which the trace is G : dF
        const Number shear = share * factor, volumetric = share * lambda;
        Matrix3<Change> C     = shear * B;
        const Change pressure = volumetric * trace(B);
        for (int A = 0; A < 3; ++A)
          C(A, A) += pressure;
        return mu * dF + G * C;
      }

      /// With g = dN/dX and h = G g / J^2, row a of dP is
      /// delta_ab mu g + (mu - lambda ln J) h_a G_b + lambda h_b G_a.
      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const NodalGradient<Change> &dF) const
      {
        const int b        = dF.component;
        const Number shear = share * factor, volumetric = share * lambda;
        Matrix3<Change> dP;
        const Change h_b = volumetric * dot(G, b, dF.gradient);
        for (int a = 0; a < 3; ++a)
        {
          const Change h_a = shear * dot(G, a, dF.gradient);
          for (int A = 0; A < 3; ++A)
            dP(a, A) = h_a * G(b, A) + h_b * G(a, A);
        }
        for (int A = 0; A < 3; ++A)
          dP(b, A) += mu * dF.gradient[A];
        return dP;
      }
    };

    template <class Number>
    SOFTCELL_HOST_DEVICE Linearisation<Number> linearisation(const Matrix3<Number> &F,
                                                             const Number &pressure) const
    {
      const Real tiny(1e-37F); // keeps the share finite, so that moduli of 0 make 0 of it
      const Matrix3<Number> G = cofactor(F);
      const Number J          = dot(F, 0, G.entries);
      return {mu, Number(0), mu - pressure, G, Number(1) / (J * J + tiny)};
    }
  };
} // namespace softcell
