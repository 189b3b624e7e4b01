// SPDX-License-Identifier: LGPL-2.1-or-later
// Brunet's mapping of forces at surface nodes to the cells that hold them.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/geometry/surface.h>

#include <vector>

namespace softcell
{
  /// One patch of a single point per vertex of the region's triangles (Brunet's mapping H, eq. 4.14
  /// to 4.17). The weight is the vertex' share of area, a third of each of its triangles in the
  /// region, so that a uniform traction gives T^s of eq. 4.14 exactly; the normal is the mean of
  /// theirs. Each vertex goes to the nearest cell, of several to that of the highest precedence.
  /// Material labels and cell sizes are not known: no use for Nitsche's method. Collective.
  /// @param reach how far a vertex may lie outside all cells. Units: m
  /// @throws BadInput on all ranks if a vertex lies farther outside.
  std::vector<SurfacePatch> nodal_surface_patches(const Discretization &discretization,
                                                  const Surface &surface,
                                                  const Region &region,
                                                  double reach);
} // namespace softcell
