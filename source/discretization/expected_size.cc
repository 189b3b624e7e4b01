// SPDX-License-Identifier: LGPL-2.1-or-later
// How large a discretization will be, before it is built.

#include <softcell/discretization/expected_size.h>

#include <softcell/geometry/surface.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  namespace
  {
    /// Nodes and couplings of n hexahedra of one degree p. Along an axis, a cell has one node that
    /// it shares, with 2 p + 1 couplings, and p - 1 inside with p + 1: in all p (p + 2).
    void add_hexahedra(ExpectedSize &size, const unsigned int degree, const double n)
    {
      size.cells += n;
      size.nodes += n * std::pow(degree, 3);
      size.couplings += n * std::pow(degree * (degree + 2.), 3);
    }

    /// Cells of these edges that a surface of all directions cuts, per area.
    double cut_per_area(const Direction &h)
    {
      return 0.5 * (1 / (h[1] * h[2]) + 1 / (h[0] * h[2]) + 1 / (h[0] * h[1]));
    }

    /// A surface of all directions meets two faces of the grid for each cut cell: these lie between
    /// cut cells. Of the others half lead to full cells, which is one more. A face couples the
    /// nodes that its cells do not share, p (p + 1)^2 in each, both ways. Neighbouring faces couple
    /// some of the same: the factor for that was fitted to spheres of degrees 1 and 2.
    void add_ghost_faces(ExpectedSize &size, const unsigned int degree)
    {
      const double n = std::pow(degree + 1, 2);
      size.ghost_faces += 3 * size.cut_cells;
      size.couplings += size.ghost_faces * 2 * std::pow(degree * n, 2) * (n - 1) / n;
    }

    ExpectedSize size_of_grid(const DiscretizationParameters &parameters, const Body &body)
    {
      Direction h;
      const std::array<double, 3> n = grid_cells(parameters.grid, body.bounding_box(), h);
      const double area             = body.surface().area();

      ExpectedSize size;
      size.grid_cells    = n[0] * n[1] * n[2];
      double half_filled = body.volume() / (h[0] * h[1] * h[2]); // cells, cut ones by their filling
      size.cut_cells     = area * cut_per_area(h);
      // A cell is halved if the surface is nearer than half of its edge: that is where it meets a
      // box of twice the size, in each direction of which a cell has two places.
      for (unsigned int level = 0; level < parameters.grid.surface_refinement; ++level)
      {
        size.grid_cells += 7 * 2 * size.cut_cells;
        half_filled += 7 * size.cut_cells;
        size.cut_cells *= 4;
      }
      size.grid_cells     = std::max(size.grid_cells, half_filled);
      size.cut_cells      = std::min(size.cut_cells, size.grid_cells);
      const double active = std::min(half_filled + size.cut_cells / 2, size.grid_cells);
      add_hexahedra(size, parameters.degree, active);
      if (parameters.cut.ghost_penalty > 0 && has_cut_levels(parameters.method))
        add_ghost_faces(size, parameters.degree);
      return size;
    }

    /// Six tetrahedra meet in a ring of 5.1 around an edge; there are 5.5 to a vertex.
    ExpectedSize size_of_tetrahedra(const unsigned int degree, const double n)
    {
      ExpectedSize size;
      size.cells            = n;
      const double vertices = n / 5.5, edges = n + vertices;
      size.nodes     = degree == 1 ? vertices : vertices + edges;
      size.couplings = degree == 1 ? vertices + 2 * edges : 65 * vertices + 23.4 * edges;
      return size;
    }
  } // namespace

  ExpectedSize expected_size(const DiscretizationParameters &parameters,
                             const GeometryParameters &geometry,
                             const Body &body)
  {
    const bool is_tetrahedra = parameters.method == "tetrahedra";
    if (!is_tetrahedra && parameters.method != "hexahedra")
      return size_of_grid(parameters, body);
    if (!parameters.mesh.file.empty())
      return {};

    const Box box                       = body.bounding_box();
    const std::array<unsigned int, 3> n = cells_along(box, parameters.grid.cells);
    const double cells                  = double(n[0]) * n[1] * n[2];
    ExpectedSize size;
    if (!is_tetrahedra) // of a cylinder, the corners of the box stay empty
      add_hexahedra(size, parameters.degree, cells * body.volume() / box.volume());
    else if (geometry.type == "box" && parameters.mesh.size == 0)
      size = size_of_tetrahedra(parameters.degree, 6 * cells);
    else
    {
      double edge = parameters.mesh.size;
      if (edge == 0)
        edge = std::min(
          {box.side_length(0) / n[0], box.side_length(1) / n[1], box.side_length(2) / n[2]});
      size = size_of_tetrahedra(parameters.degree, body.volume() / (0.114 * std::pow(edge, 3)));
    }
    return size;
  }
} // namespace softcell
