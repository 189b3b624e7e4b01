// SPDX-License-Identifier: LGPL-2.1-or-later
// Tetrahedral meshes: of any body by CGAL, from a Gmsh file, and the structured one of a box.
#pragma once

#include <softcell/discretization/mesh.h>
#include <softcell/geometry/body.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <string>

namespace softcell
{
  /// Meshes a body by Delaunay refinement (CGAL's Mesh_3), the same on every run.
  ///
  /// A body of one material is meshed from its surface, of which edges sharper than 60 degrees are
  /// kept; one of several materials from its labels, so that no cell straddles two. Slivers are
  /// removed. Rank 0 does the work and sends the mesh to the others. Collective.
  ///
  /// @param size mean length of an edge, roughly. Units: m
  /// @throws BadInput if nothing comes of it.
  Mesh tetrahedral_mesh(MPI_Comm communicator, const Body &body, double size);

  /// Reads a Gmsh file (MSH version 1, 2 or 4 in ASCII) of straight tetrahedra or hexahedra.
  /// Physical numbers of boundary faces become patch numbers, 0 where a face has none. Collective.
  /// @param scale factor from the file's unit to metres.
  /// @throws BadInput
  Mesh read_gmsh(MPI_Comm communicator, const std::string &file, double scale);

  /// The box with a corner at the origin in n[0] x n[1] x n[2] cuboids of six tetrahedra each,
  /// which share the cuboid's diagonal from its lowest to its highest corner (Kuhn's subdivision).
  Mesh kuhn_box(const Point &size, const std::array<unsigned int, 3> &n);

  /// Volume of a mesh; a hexahedron counts as six tetrahedra around a diagonal. Units: m^3
  double volume(const Mesh &mesh);
} // namespace softcell
