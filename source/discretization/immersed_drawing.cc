// SPDX-License-Identifier: LGPL-2.1-or-later
// The cells of an immersed discretization for VTK.

#include <softcell/discretization/immersed.h>

#include <vtkCellType.h>
#include <vtkHigherOrderHexahedron.h>

#include <cmath>

namespace softcell
{
  DrawnCells Immersed::drawn_cells() const
  {
    const int p = degree(), order[3] = {p, p, p};
    std::vector<unsigned int> place_in_vtk(shapes_.n_nodes());
    for (int k = 0, i = 0; k <= p; ++k)
      for (int j = 0; j <= p; ++j)
        for (int l = 0; l <= p; ++l, ++i)
          place_in_vtk[i] = vtkHigherOrderHexahedron::PointIndexFromIJK(l, j, k, order);

    // VTK's cells have equidistant points, ours Gauss-Lobatto's: the same up to degree 2
    std::vector<Point> unit_points;
    for (int k = 0; k <= p; ++k)
      for (int j = 0; j <= p; ++j)
        for (int l = 0; l <= p; ++l)
          unit_points.emplace_back(double(l) / p, double(j) / p, double(k) / p);

    DrawnCells drawn;
    drawn.offsets = {0};
    std::vector<unsigned int> point_of_node(node_positions_.size(), none);
    ShapeTable shapes;
    for (unsigned int c = 0; c < cells_.size(); ++c)
    {
      const Cell &cell = cells_[c];
      const Box box    = lattice_.box(cell.place);
      evaluate(c, unit_points, shapes);
      std::vector<unsigned int> corners(unit_points.size());
      for (unsigned int i = 0; i < corners.size(); ++i)
      {
        PointShapes here;
        for (unsigned int m = 0; m < shapes.n_nodes; ++m)
          if (const double N = shapes.value(i)[m]; std::abs(N) > 1e-12)
          {
            here.nodes.push_back(nodes(c)[m]);
            here.values.push_back(N);
          }
        // cells share the points that are nodes; all others each cell has for itself
        unsigned int own    = none;
        unsigned int &point = here.nodes.size() == 1 ? point_of_node[here.nodes[0]] : own;
        if (point == none)
        {
          point = drawn.points.size();
          drawn.points.push_back(box.unit_to_real(unit_points[i]));
          drawn.shapes.push_back(std::move(here));
        }
        corners[place_in_vtk[i]] = point;
      }
      drawn.connectivity.insert(drawn.connectivity.end(), corners.begin(), corners.end());
      drawn.offsets.push_back(drawn.connectivity.size());
      drawn.types.push_back(p == 1 ? VTK_HEXAHEDRON : VTK_LAGRANGE_HEXAHEDRON);
      drawn.patches.push_back(c);
      drawn.cut_fraction.push_back(cell.cut_fraction);
    }
    return drawn;
  }
} // namespace softcell
