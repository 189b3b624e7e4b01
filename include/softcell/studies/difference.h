// SPDX-License-Identifier: LGPL-2.1-or-later
// How far one discretization's displacement is from another's.
#pragma once

#include <softcell/discretization/discretization.h>

namespace softcell
{
  /// Errors relative to a reference, over the body as the reference's integration points see it.
  struct Difference
  {
    double relative_l2 = 0; // |u - u_ref| / |u_ref| in L2
    double relative_h1 = 0; // the same of the gradients: |grad(u - u_ref)| / |grad u_ref| in L2
    double missed      = 0; // fraction of the volume that was left out: no cell of the other
                            // discretization within reach
  };

  /// The difference of u on `discretization` from the reference (the norm of Brunet fig. 4.6). The
  /// two may be partitioned differently over the same ranks; both vectors have ghost values.
  /// Collective.
  /// @param reach how far a point of the reference may lie outside the other's cells, which are
  ///              extended up to there. Units: m
  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &reference,
                        const Vector &reference_u,
                        double reach);
} // namespace softcell
