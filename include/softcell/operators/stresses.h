// SPDX-License-Identifier: LGPL-2.1-or-later
// Which stresses a tangent knows.
#pragma once

namespace softcell
{
  /// Which stresses a tangent knows.
  enum class Stresses
  {
    all,
    /// Of Neo-Hookean, the factor mu - lambda ln J is kept between -mu s_1^2 and mu s_1 s_2, with
    /// the smallest stretches s_1 <= s_2: in tension it is there by itself, and elsewhere this
    /// leaves out as much compressive stress as it must, so that the tangent is positive
    /// semi-definite at every point.
    tensile
  };
} // namespace softcell
