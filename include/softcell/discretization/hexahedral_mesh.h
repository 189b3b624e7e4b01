// SPDX-License-Identifier: LGPL-2.1-or-later
// Hexahedral meshes of the two shapes that have a natural one.
#pragma once

#include <softcell/discretization/mesh.h>

#include <array>

namespace softcell
{
  /// The box with a corner at the origin in n[0] x n[1] x n[2] equal cells.
  Mesh hexahedral_box(const Point &size, const std::array<unsigned int, 3> &n);

  /// The cylinder on z = 0 around the z axis: a square core of cells within rings of cells (an
  /// O-grid).
  /// @param across cells on a diameter, at least 3
  /// @param along  cells along the axis
  Mesh hexahedral_cylinder(double radius, double length, unsigned int across, unsigned int along);
} // namespace softcell
