// SPDX-License-Identifier: LGPL-2.1-or-later
// Better tetrahedra for a mesh that Delaunay refinement has made.

#include <softcell/discretization/sliver_removal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace softcell
{
  namespace
  {
    constexpr double bad = 0.3, flat = 0.1; // qualities

    using Edge      = std::array<unsigned int, 2>;
    using Triangle3 = std::array<unsigned int, 3>;

    double worst_of(const Mesh &mesh, const std::vector<unsigned int> &cells)
    {
      double worst = 1;
      for (const unsigned int cell : cells)
        worst = std::min(worst, quality(mesh, cell));
      return worst;
    }

    /// Moves corner v of a cell if that makes the worst cell around it better.
    void move_corner(Mesh &mesh,
                     const unsigned int cell,
                     const unsigned int v,
                     const std::vector<unsigned int> &around)
    {
      const unsigned int *corners = &mesh.corners[4 * cell];
      const auto corner = [&](const unsigned int i) { return mesh.vertices[corners[(v + i) % 4]]; };
      Point &X          = mesh.vertices[corners[v]];
      const Point original = X;
      const double edge    = (corner(1).distance(corner(2)) + corner(2).distance(corner(3)) +
                           corner(3).distance(corner(1))) /
                          3;
      const Direction normal = cross_product_3d(corner(2) - corner(1), corner(3) - corner(1));

      std::vector<Direction> directions = {normal / normal.norm(), -normal / normal.norm()};
      for (unsigned int d = 0; d < 3; ++d)
        for (const double sign : {-1., 1.})
        {
          directions.emplace_back();
          directions.back()[d] = sign;
        }
      Point best        = original;
      double best_worst = worst_of(mesh, around);
      for (const Direction &direction : directions)
        for (const double step : {0.02, 0.05, 0.1, 0.2, 0.35})
        {
          X                  = original + step * edge * direction;
          const double worst = worst_of(mesh, around);
          if (worst > best_worst)
          {
            best       = X;
            best_worst = worst;
          }
        }
      X = best;
    }

    /// The faces that belong to one cell alone, with corners in ascending order, and their cells.
    std::map<Triangle3, unsigned int> boundary_faces(const Mesh &mesh)
    {
      std::map<Triangle3, unsigned int> faces;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (unsigned int opposite = 0; opposite < 4; ++opposite)
        {
          Triangle3 face;
          for (unsigned int i = 0; i < 3; ++i)
            face[i] = mesh.corners[4 * cell + (opposite + 1 + i) % 4];
          std::sort(face.begin(), face.end());
          const auto [entry, is_new] = faces.emplace(face, cell);
          if (!is_new)
            faces.erase(entry);
        }
      return faces;
    }

    void drop_flat_boundary_cells(Mesh &mesh)
    {
      std::map<unsigned int, std::vector<Triangle3>> faces_of;
      std::set<Edge> edges;
      for (const auto &[face, cell] : boundary_faces(mesh))
      {
        faces_of[cell].push_back(face);
        for (const Edge &edge :
             {Edge{face[0], face[1]}, Edge{face[0], face[2]}, Edge{face[1], face[2]}})
          edges.insert(edge);
      }
      std::vector<unsigned int> kept;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      {
        const auto first = mesh.corners.begin() + 4 * cell;
        const auto faces = faces_of.find(cell);
        if (faces != faces_of.end() && faces->second.size() == 2 && quality(mesh, cell) < flat)
        {
          // The new faces meet in the edge between the corners that the old faces do not share.
          Edge edge;
          std::set_symmetric_difference(faces->second[0].begin(), faces->second[0].end(),
                                        faces->second[1].begin(), faces->second[1].end(),
                                        edge.begin());
          if (edges.insert(edge).second)
            continue;
        }
        kept.insert(kept.end(), first, first + 4);
      }
      mesh.corners = std::move(kept);
    }
  } // namespace

  double quality(const Mesh &mesh, const std::size_t cell)
  {
    std::array<Point, 4> X;
    for (unsigned int v = 0; v < 4; ++v)
      X[v] = mesh.vertices[mesh.corners[4 * cell + v]];
    double square = 0;
    for (unsigned int i = 0; i < 4; ++i)
      for (unsigned int j = 0; j < i; ++j)
        square += X[i].distance_square(X[j]) / 6;
    const double six_volumes = (X[3] - X[0]) * cross_product_3d(X[1] - X[0], X[2] - X[0]);
    return std::sqrt(2.) * six_volumes / (square * std::sqrt(square));
  }

  void remove_slivers(Mesh &mesh, const std::vector<bool> &movable)
  {
    std::vector<std::vector<unsigned int>> around(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.corners.size(); ++i)
      around[mesh.corners[i]].push_back(i / 4);
    for (unsigned int sweep = 0; sweep < 5; ++sweep)
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (unsigned int v = 0; v < 4 && quality(mesh, cell) < bad; ++v)
          if (const unsigned int vertex = mesh.corners[4 * cell + v]; movable[vertex])
            move_corner(mesh, cell, v, around[vertex]);
    drop_flat_boundary_cells(mesh);
  }
} // namespace softcell
