// SPDX-License-Identifier: LGPL-2.1-or-later
// The choice of a conforming mesh.

#include <softcell/discretization/mesh.h>

#include <softcell/base/exceptions.h>
#include <softcell/discretization/background_grid.h>
#include <softcell/discretization/hexahedral_mesh.h>
#include <softcell/discretization/tetrahedral_mesh.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    Mesh hexahedra(const GeometryParameters &geometry, const std::array<unsigned int, 3> &n)
    {
      if (geometry.type == "box")
        return hexahedral_box(geometry.size, n);
      if (geometry.type != "cylinder")
        throw BadInput("Discretization/Method = hexahedra is available for Geometry/Type = box and "
                       "cylinder, not for '" +
                       geometry.type + "'; take tetrahedra or an immersed method.");
      if (n[0] < 3)
        throw BadInput("Discretization/Cells = " + std::to_string(n[0]) +
                       " is too few for a cylinder of hexahedra, which needs at least 3 across.");
      return hexahedral_cylinder(geometry.radius, geometry.length, n[0], n[2]);
    }

    /// Says so if the mesh does not fill the body.
    void check_volume(const Mesh &mesh,
                      const Body &body,
                      const std::string &advice,
                      std::vector<std::string> &remarks)
    {
      const double found = volume(mesh), expected = body.volume();
      if (std::abs(found - expected) < 0.05 * expected)
        return;
      std::ostringstream text;
      text.precision(4);
      text << "The mesh of " << mesh.n_cells() << " cells has a volume of " << found
           << " m^3, the body of " << expected << " m^3; " << advice << '.';
      remarks.push_back(text.str());
    }
  } // namespace

  std::array<unsigned int, 3> cells_along(const Box &box, const std::vector<unsigned int> &cells)
  {
    GridParameters grid;
    grid.cells = cells;
    Direction h;
    grid_cells(grid, box, h);
    std::array<unsigned int, 3> n;
    for (unsigned int d = 0; d < 3; ++d)
      n[d] = std::lround(box.side_length(d) / h[d]);
    return n;
  }

  void MeshParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Mesh size", size,
                      "Units: m. Mean edge of the tetrahedra; 0 takes the shortest side of the "
                      "bounding box divided by Cells.",
                      dealii::Patterns::Double(0));
    prm.add_parameter("Mesh file", file,
                      "Gmsh file (.msh, ASCII) with the tetrahedra or hexahedra to take instead of "
                      "meshing the body; in the unit that Geometry/Scale tells.",
                      dealii::Patterns::Anything());
  }

  Mesh make_mesh(MPI_Comm communicator,
                 const CellShape shape,
                 const std::vector<unsigned int> &cells,
                 const MeshParameters &parameters,
                 const GeometryParameters &geometry,
                 const Body &body,
                 std::vector<std::string> &remarks)
  {
    const Box box                       = body.bounding_box();
    const std::array<unsigned int, 3> n = cells_along(box, cells);
    if (!parameters.file.empty())
    {
      Mesh mesh = read_gmsh(communicator, parameters.file, geometry.scale);
      if ((mesh.corners_per_cell == 4) != (shape == CellShape::tetrahedra))
        throw BadInput("Discretization/Mesh file = " + parameters.file + " holds " +
                       (mesh.corners_per_cell == 4 ? "tetrahedra" : "hexahedra") +
                       "; set Discretization/Method accordingly.");
      check_volume(mesh, body, "section Geometry has to describe what the mesh fills", remarks);
      return mesh;
    }
    if (shape == CellShape::hexahedra)
      return hexahedra(geometry, n);
    if (geometry.type == "box" && parameters.size == 0)
      return kuhn_box(geometry.size, n);

    double size = parameters.size;
    if (size == 0)
      size =
        std::min({box.side_length(0) / n[0], box.side_length(1) / n[1], box.side_length(2) / n[2]});
    Mesh mesh = tetrahedral_mesh(communicator, body, size);
    check_volume(mesh, body, "a smaller Discretization/Mesh size brings them together", remarks);
    return mesh;
  }
} // namespace softcell
