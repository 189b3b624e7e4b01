// SPDX-License-Identifier: LGPL-2.1-or-later
// Hooke's law for small strains; what a law offers is told in laws.h.
#pragma once

#include <softcell/mechanics/hyperelastic.h>

namespace softcell
{
  /// Hooke's law in the small strain e = (F + F^T)/2 - I, without rotations: W = lambda/2 (tr e)^2
  /// + mu e : e. All stresses are the same. It never refuses an F except NaN.
  template <class Real = double>
  struct LinearElastic : Hyperelastic<LinearElastic, Real>
  {
    using Base = Hyperelastic<softcell::LinearElastic, Real>;
    using Base::cauchy_stress, Base::first_piola_stress, Base::linearisation, Base::lambda,
      Base::mu;

    template <class Number>
    SOFTCELL_HOST_DEVICE static auto is_admissible(const Number &J)
    {
      return J == J;
    }

    /// tr e
    template <class Number>
    SOFTCELL_HOST_DEVICE static Number volumetric_strain(const Matrix3<Number> &F)
    {
      return trace(displacement_gradient(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE static Matrix3<Number> volumetric_gradient(const Matrix3<Number> &)
    {
      return identity<Number>();
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Number energy(const Matrix3<Number> &F) const
    {
      const Matrix3<Number> e = small_strain(F);
      const Number tr_e       = trace(e);
      return lambda / 2 * tr_e * tr_e + mu * double_contraction(e, e);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> first_piola_stress(const Matrix3<Number> &F,
                                                            const Number &pressure) const
    {
      return pressure * identity<Number>() + 2 * mu * small_strain(F);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> cauchy_stress(const Matrix3<Number> &F,
                                                       const Number &pressure) const
    {
      return first_piola_stress(F, pressure);
    }

    /// dP = lambda tr(dF) I + mu (dF + dF^T), whatever F is.
    struct Linearisation
    {
      Real mu, lambda;

      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const Matrix3<Change> &dF) const
      {
        const Change pressure = lambda * trace(dF);
        return pressure * identity<Change>() + mu * (dF + transpose(dF));
      }

      template <class Change>
      SOFTCELL_HOST_DEVICE Matrix3<Change> operator()(const NodalGradient<Change> &dF) const
      {
        const int b = dF.component;
        Matrix3<Change> dP{};
        for (int A = 0; A < 3; ++A)
          dP(A, A) = lambda * dF.gradient[b];
        for (int A = 0; A < 3; ++A)
        {
          dP(A, b) += mu * dF.gradient[A];
          dP(b, A) += mu * dF.gradient[A];
        }
        return dP;
      }
    };

    template <class Number>
    SOFTCELL_HOST_DEVICE Linearisation linearisation(const Matrix3<Number> &, const Number &) const
    {
      return {mu, Real(0)};
    }
  };
} // namespace softcell
