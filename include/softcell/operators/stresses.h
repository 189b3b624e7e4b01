// SPDX-License-Identifier: LGPL-2.1-or-later
// Which stresses a tangent knows.
#pragma once

namespace softcell
{
  /// Which stresses a tangent knows.
  enum class Stresses
  {
    all,
    /// Of Neo-Hookean, the factor mu - lambda ln J is kept between -mu s_1^2 and mu s_1 s_2, or
    /// close to that, with the smallest stretches s_1 <= s_2. So the tangent is positive
    /// semi-definite at every point (for lambda >= 0), and little more compressive stress is left
    /// out, or tensile stress under a tension from all sides, than must be.
    tensile
  };
} // namespace softcell
