// SPDX-License-Identifier: LGPL-2.1-or-later
// The cells of an immersed discretization for VTK.
#include <softcell/discretization/immersed.h>

#include <vtkCellType.h>
#include <vtkHigherOrderHexahedron.h>

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

    DrawnCells drawn;
    drawn.offsets = {0};
    std::vector<unsigned int> point_of_node(node_positions_.size(), none);
    const auto add_point = [&](const Point &X, std::vector<unsigned int> n, std::vector<double> v) {
      drawn.points.push_back(X);
      drawn.shapes.push_back({std::move(n), std::move(v), {}, 0});
      return static_cast<unsigned int>(drawn.points.size() - 1);
    };
    for (unsigned int c = 0; c < cells_.size(); ++c)
    {
      const Cell &cell   = cells_[c];
      const auto masters = nodes(c);
      const Box box      = lattice_.box(cell.place);
      std::vector<unsigned int> corners(shapes_.n_nodes());
      for (unsigned int i = 0; i < shapes_.n_nodes(); ++i)
      {
        // a hanging node gets a point of its own in each cell
        std::vector<unsigned int> n = {masters[std::min<unsigned int>(i, masters.size() - 1)]};
        std::vector<double> v       = {1};
        if (cell.has_hanging())
        {
          n.clear();
          v.clear();
          for (unsigned int m = 0; m < masters.size(); ++m)
            if (const double f = condensations_[cell.hanging + i * masters.size() + m])
            {
              n.push_back(masters[m]);
              v.push_back(f);
            }
        }
        if (n.size() > 1)
          corners[place_in_vtk[i]] = add_point(box.unit_to_real(shapes_.node(i)), n, v);
        else
        {
          unsigned int &point = point_of_node[n[0]];
          if (point == none)
            point = add_point(node_positions_[n[0]], n, v);
          corners[place_in_vtk[i]] = point;
        }
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
