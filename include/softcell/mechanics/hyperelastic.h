// SPDX-License-Identifier: LGPL-2.1-or-later
// What every law has once it gives its stress and tangent under a pressure; laws.h tells what each
// function is.
#pragma once

#include <softcell/mechanics/kinematics.h>

namespace softcell
{
  /// The parameters of Law<Real>, a law derived from this, and what follows from its
  /// volumetric_strain(F), first_piola_stress(F, p) and linearisation(F, p).
  template <template <class> class Law, class Real>
  struct Hyperelastic
  {
    Real lambda, mu;

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> first_piola_stress(const Matrix3<Number> &F) const
    {
      return law().first_piola_stress(F, pressure(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> cauchy_stress(const Matrix3<Number> &F,
                                                       const Number &pressure) const
    {
      return softcell::cauchy_stress(law().first_piola_stress(F, pressure), F);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Matrix3<Number> cauchy_stress(const Matrix3<Number> &F) const
    {
      return law().cauchy_stress(F, pressure(F));
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE auto linearisation(const Matrix3<Number> &F) const
    {
      auto tangent   = law().linearisation(F, pressure(F));
      tangent.lambda = lambda;
      return tangent;
    }

  private:
    SOFTCELL_HOST_DEVICE const Law<Real> &law() const
    {
      return static_cast<const Law<Real> &>(*this);
    }

    template <class Number>
    SOFTCELL_HOST_DEVICE Number pressure(const Matrix3<Number> &F) const
    {
      return lambda * Law<Real>::volumetric_strain(F);
    }
  };
} // namespace softcell
