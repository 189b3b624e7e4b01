// SPDX-License-Identifier: LGPL-2.1-or-later
// Better tetrahedra for a mesh that Delaunay refinement has made.
#pragma once

#include <softcell/discretization/mesh.h>

#include <vector>

namespace softcell
{
  /// 6 sqrt(2) V / l^3 with the root mean square l of the edges: 1 for a regular tetrahedron, 0 for
  /// a flat one.
  double quality(const Mesh &mesh, std::size_t cell);

  /// Rids a tetrahedral mesh of slivers, which Delaunay refinement leaves behind.
  ///
  /// A vertex of a bad cell is moved to the place, of some tried, where the worst of its cells is
  /// best. A flat cell left on the boundary with two of its faces is dropped: its other two faces
  /// take their place. The outcome depends on the mesh alone (CGAL's own perturbation and exudation
  /// depend on memory addresses).
  ///
  /// @param movable (n_vertices) false for the vertices that lie on boundaries and interfaces.
  void remove_slivers(Mesh &mesh, const std::vector<bool> &movable);
} // namespace softcell
