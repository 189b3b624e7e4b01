// SPDX-License-Identifier: LGPL-2.1-or-later
// Which tangent of the internal forces.
#pragma once

namespace softcell
{
  /// Which tangent of the internal forces.
  enum class Tangent
  {
    exact,
    /// One that is positive semi-definite at every point (for lambda >= 0), exact at rest and near
    /// it under small strains. Of Neo-Hookean, the factor f = mu - lambda ln J is limited to
    /// f_0 between -mu s_1^2 and mu s_1 s_2, or close to that, with the smallest stretches
    /// s_1 <= s_2, and f - f_0 is added to lambda (no less than to 0). With A = dF F^-1 that
    /// replaces (f - f_0) tr A^2 by (f - f_0) (tr A)^2: inside a body both are the same where
    /// (f - f_0) / J does not vary, as J ((tr A)^2 - tr A^2), the second change of J, is a
    /// divergence. InvertibleNeoHookean has only a share of f_0 and of what is added where J is
    /// near the range in which it is continued, and none of both in it.
    definite
  };
} // namespace softcell
