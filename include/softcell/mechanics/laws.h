// SPDX-License-Identifier: LGPL-2.1-or-later
// Hyperelastic laws at a material point, for any number type, on host and device.
//
// A law is a plain struct of its Lame parameters (Units: Pa) with
//   energy(F)               strain energy density W. Units: J/m^3
//   first_piola_stress(F)   P = dW/dF. Units: Pa
//   cauchy_stress(F)        sigma = P F^T / J. Units: Pa
//   linearisation(F)        the tangent at F: an object that turns dF into dP = (dP/dF) : dF,
//                           for any dF or for a NodalGradient. dF may be a pack where F is a
//                           scalar.
//   volumetric_strain(F)    v, of which W has the part lambda/2 v^2. Units: 1
//   volumetric_gradient(F)  dv/dF. Units: 1
//   is_admissible(J)        whether all of these may be called where det F = J: a bool, or the
//                           mask of a pack; false for NaN.
// first_piola_stress, cauchy_stress and linearisation also take a pressure p (Units: Pa) behind F,
// which replaces lambda v: then they belong to W without its part lambda/2 v^2, and p v with p
// fixed. `Real` is the type of the parameters; F's numbers are Real, packs of Real or derivatives
// of Real.
#pragma once

#include <softcell/mechanics/invertible_neo_hookean.h>
#include <softcell/mechanics/linear_elastic.h>
#include <softcell/mechanics/neo_hookean.h>
#include <softcell/mechanics/saint_venant_kirchhoff.h>

namespace softcell
{
  /// A law from Young modulus E (Units: Pa) and Poisson ratio nu (Brunet sec. 2.3.1).
  template <template <class> class Law, class Real>
  SOFTCELL_HOST_DEVICE Law<Real> make_law(const Real E, const Real nu)
  {
    return {E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))};
  }
} // namespace softcell
