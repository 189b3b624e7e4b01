// SPDX-License-Identifier: LGPL-2.1-or-later
// A conforming mesh as plain arrays, and how a user asks for one.
#pragma once

#include <softcell/base/types.h>
#include <softcell/geometry/body.h>
#include <softcell/geometry/geometry.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <array>
#include <string>
#include <vector>

namespace softcell
{
  /// A conforming mesh of cells that are all tetrahedra or all hexahedra, of positive volume.
  struct Mesh
  {
    std::vector<Point> vertices;
    unsigned int corners_per_cell = 4; // or 8
    std::vector<unsigned int> corners; // (n_cells, corners_per_cell) in deal.II's order

    /// Boundary faces with the numbers of their patches, where the mesh brings them along: (n, 3)
    /// corners of triangles, (n, 4) of quadrilaterals. Without any, a face belongs to the patch of
    /// the body that is nearest.
    std::vector<unsigned int> face_corners;
    std::vector<unsigned int> face_patches;

    /// Boundary faces with all corners at this distance from the z axis are curved as the cylinder;
    /// 0: none.
    double mantle_radius = 0;

    std::size_t n_cells() const
    {
      return corners.size() / corners_per_cell;
    }

    template <class Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &vertices &corners_per_cell &corners &face_corners &face_patches &mantle_radius;
    }
  };

  enum class CellShape
  {
    tetrahedra,
    hexahedra
  };

  /// What the section Discretization says of conforming meshes alone.
  struct MeshParameters
  {
    double size = 0; // mean edge of tetrahedra in m; 0: shortest side of the bounding box / Cells
    std::string file = ""; // Gmsh file to read instead of meshing

    /// Declares the entries of the section, which the caller has entered.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Cells along x, y and z of what the entry `Cells` asks for. @throws BadInput
  std::array<unsigned int, 3> cells_along(const Box &box, const std::vector<unsigned int> &cells);

  /// Makes or reads the mesh, the same on all ranks: hexahedra of a box or a cylinder, Kuhn's
  /// tetrahedra of a box unless a size is given, CGAL's tetrahedra of any other body. Collective.
  /// @param cells   the entry `Cells`: cells across the shortest side of the bounding box, or along
  /// x, y and z
  /// @param remarks gets a sentence on whatever a user should know of the mesh.
  /// @throws BadInput
  Mesh make_mesh(MPI_Comm communicator,
                 CellShape shape,
                 const std::vector<unsigned int> &cells,
                 const MeshParameters &parameters,
                 const GeometryParameters &geometry,
                 const Body &body,
                 std::vector<std::string> &remarks);
} // namespace softcell
