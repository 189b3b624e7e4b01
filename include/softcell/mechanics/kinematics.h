// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures of deformation at a material point. F = I + du/dX throughout (Brunet sec. 2.2);
// Units: 1.
#pragma once

#include <softcell/mechanics/tensor.h>

namespace softcell
{
  /// The change of F when the displacement of one node along one axis grows: e_component (x) dN/dX.
  template <class Number>
  struct NodalGradient
  {
    int component;
    Number gradient[3]; // dN/dX. Units: 1/m
  };

  /// du/dX = F - I.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> displacement_gradient(const Matrix3<Number> &F)
  {
    return F - identity<Number>();
  }

  /// C = F^T F.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> right_cauchy_green(const Matrix3<Number> &F)
  {
    return transpose(F) * F;
  }

  /// E = (C - I) / 2, written in du/dX so that small strains keep their digits.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> green_lagrange_strain(const Matrix3<Number> &F)
  {
    const Matrix3<Number> H = displacement_gradient(F), Ht = transpose(H);
    const Number two(2);
    Matrix3<Number> E = H + Ht + Ht * H;
    for (Number &e : E.entries)
      e /= two;
    return E;
  }

  /// The small strain (F + F^T) / 2 - I.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> small_strain(const Matrix3<Number> &F)
  {
    const Matrix3<Number> H = displacement_gradient(F);
    const Number two(2);
    Matrix3<Number> e = H + transpose(H);
    for (Number &entry : e.entries)
      entry /= two;
    return e;
  }

  /// J - 1 = det F - 1 by the invariants of du/dX, so that small changes of volume keep their
  /// digits.
  template <class Number>
  SOFTCELL_HOST_DEVICE Number volume_change(const Matrix3<Number> &F)
  {
    const Matrix3<Number> H = displacement_gradient(F);
    const Number minors     = H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0) + H(1, 1) * H(2, 2) -
                          H(1, 2) * H(2, 1) + H(2, 2) * H(0, 0) - H(2, 0) * H(0, 2);
    return trace(H) + minors + determinant(H);
  }

  /// Cauchy stress P F^T / J from the first Piola-Kirchhoff stress.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> cauchy_stress(const Matrix3<Number> &P,
                                                     const Matrix3<Number> &F)
  {
    const Number s = Number(1) / determinant(F);
    return s * (P * transpose(F));
  }
} // namespace softcell
