// SPDX-License-Identifier: LGPL-2.1-or-later
// Which stresses a tangent knows.
#pragma once

namespace softcell
{
  /// Which stresses a tangent knows.
  enum class Stresses
  {
    all,
    /// Of Neo-Hookean, the factor mu - lambda ln J is kept between -mu s^2 and mu s^2, with s the
    /// smallest stretch: in tension it is there by itself, and elsewhere this leaves out the
    /// compressive stress. So the tangent is positive semi-definite at every point.
    tensile
  };
} // namespace softcell
