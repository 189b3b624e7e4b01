// SPDX-License-Identifier: LGPL-2.1-or-later
// How large a discretization will be, before it is built.
#pragma once

#include <softcell/discretization/methods.h>

namespace softcell
{
  /// Numbers over all ranks, within about a fifth for bodies that are some cells thick.
  struct ExpectedSize
  {
    double grid_cells  = 0; // of the background grid, those beside the body too; 0 for a mesh
    double cells       = 0;
    double cut_cells   = 0;
    double nodes       = 0;
    double couplings   = 0; // pairs of nodes that share a cell or ghost face: blocks of the tangent
    double ghost_faces = 0;
  };

  /// Foresees what make_discretization() makes, from the body's volume and surface; a mesh that is
  /// read from a file is not foreseen, and all numbers are 0.
  /// @throws BadInput
  ExpectedSize expected_size(const DiscretizationParameters &parameters,
                             const GeometryParameters &geometry,
                             const Body &body);
} // namespace softcell
