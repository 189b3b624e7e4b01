// SPDX-License-Identifier: LGPL-2.1-or-later
// The body's surface, cut into pieces by the cells.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/surface.h>
#include <softcell/quadrature/octree.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace softcell
{
  namespace
  {
    double triangle_area(const Point &a, const Point &b, const Point &c)
    {
      return 0.5 * dealii::cross_product_3d(b - a, c - a).norm();
    }

    double polygon_area(const std::vector<Point> &corners)
    {
      double area = 0;
      for (unsigned int i = 2; i < corners.size(); ++i)
        area += triangle_area(corners[0], corners[i - 1], corners[i]);
      return area;
    }

    /// A point inside a convex polygon.
    Point middle(const std::vector<Point> &corners)
    {
      Direction sum;
      for (const Point &corner : corners)
        sum += corner;
      return Point(sum / double(corners.size()));
    }

    double smallest(const Direction &v)
    {
      return std::min({v[0], v[1], v[2]});
    }
  } // namespace

  std::vector<unsigned int> Immersed::triangles_of(const Region &region) const
  {
    const Surface &surface = body_.surface();
    std::vector<unsigned int> triangles;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto [a, b, c] = surface.corners(t);
      const Point centre   = a + ((b - a) + (c - a)) / 3;
      if (region.contains(centre, surface.normal(t), surface.patches()[t]))
        triangles.push_back(t);
    }
    if (triangles.empty())
      throw BadInput("Regions/" + region.name() + " selects nothing of the body's surface of " +
                     std::to_string(surface.triangles().size()) +
                     " triangles; correct its condition (lengths are in m).");
    return triangles;
  }

  bool Immersed::is_active(const Lattice::Cell &place) const
  {
    return owned_cell(place) != none || everyones_cut_cells_.count(Lattice::key(place)) > 0 ||
           side_of(body_, lattice_.box(place)) == Side::inside;
  }

  std::optional<Lattice::Cell> Immersed::nearest_active(const Lattice::Cell &place,
                                                        const Point &X) const
  {
    std::optional<Lattice::Cell> nearest;
    double nearest_distance = 0;
    Lattice::Cell block{place.lower, 3 * place.size};
    for (int &i : block.lower)
      i -= place.size;
    Box around = lattice_.box(block);
    around.extend(-0.5 * smallest(lattice_.spacing)); // its sides are those of other cells too
    lattice_.for_each_leaf(around, [&](const Lattice::Cell &near) {
      const double d = distance(X, near);
      if ((!nearest || d < nearest_distance) && is_active(near))
      {
        nearest          = near;
        nearest_distance = d;
      }
    });
    return nearest;
  }

  std::vector<Immersed::Piece> Immersed::pieces(const std::vector<unsigned int> &triangles,
                                                double &lost) const
  {
    const Surface &surface  = body_.surface();
    const double negligible = 1e-13 * std::pow(smallest(lattice_.spacing), 2); // round-off
    std::vector<Piece> result;
    lost = 0;
    for (const unsigned int t : triangles)
    {
      // what lies in a face between two cells belongs to the one on the body's side
      const Direction shift = -1e-9 * smallest(lattice_.spacing) * surface.normal(t);
      auto corners          = surface.corners(t);
      for (Point &corner : corners)
        corner += shift;
      const Box box(corners);
      const auto &[lower, upper] = box.get_boundary_points();
      const bool in_one =
        lattice_.leaf(lattice_.index(lower)).lower == lattice_.leaf(lattice_.index(upper)).lower;

      lattice_.for_each_leaf(box, [&](const Lattice::Cell &place) {
        unsigned int cell = owned_cell(place);
        if (cell == none && is_active(place))
          return; // another rank's
        std::vector<Point> polygon(corners.begin(), corners.end());
        if (!in_one)
          polygon = clip(corners, lattice_.box(place));
        if (polygon_area(polygon) < negligible) // a cell that it only touches
          return;
        if (cell == none)
        {
          const auto near = nearest_active(place, middle(polygon)); // corners are near to several
          if (near)
            cell = owned_cell(*near);
          else
            lost += polygon_area(polygon);
        }
        if (cell != none)
          result.push_back({cell, t, std::move(polygon)});
      });
    }
    return result;
  }

  std::vector<SurfacePatch> Immersed::surface_patches(const Region &region) const
  {
    const Surface &surface                    = body_.surface();
    const std::vector<unsigned int> triangles = triangles_of(region);
    double lost, area = 0;
    const std::vector<Piece> all_pieces = pieces(triangles, lost);
    for (const unsigned int t : triangles)
      area += surface.area(t);
    if (lost > 1e-3 * area)
      throw BadInput("Regions/" + region.name() + ": " + std::to_string(100 * lost / area) +
                     " % of its area is farther than a cell from every cell that holds some of the "
                     "body; give more 'Cells' in section Discretization, a lower 'Smallest volume "
                     "fraction', or fewer 'Refinement steps'.");

    std::map<unsigned int, SurfacePatch> patches; // by cell
    const dealii::QWitherdenVincentSimplex<2> rule(std::min(degree() + 1, 7u));
    for (const Piece &piece : all_pieces)
    {
      SurfacePatch &patch = patches[piece.cell];
      const auto &X       = piece.corners;
      for (unsigned int i = 2; i < X.size(); ++i)
        for (unsigned int q = 0; q < rule.size(); ++q)
        {
          const auto &xi = rule.point(q);
          const BoundaryPoint true_point =
            body_.on_boundary(X[0] + xi[0] * (X[i - 1] - X[0]) + xi[1] * (X[i] - X[0]),
                              surface.normal(piece.triangle), surface.patches()[piece.triangle]);
          patch.points.push_back(true_point.X);
          patch.weights.push_back(2 * rule.weight(q) * triangle_area(X[0], X[i - 1], X[i]) *
                                  true_point.stretch);
          patch.normals.push_back(true_point.normal);
          patch.labels.push_back(body_.label(patch.points.back()));
        }
    }

    std::vector<SurfacePatch> result;
    for (auto &[cell, patch] : patches)
    {
      const Box box = lattice_.box(cells_[cell].place);
      std::vector<Point> unit_points;
      for (const Point &X : patch.points)
        unit_points.push_back(box.real_to_unit(X));
      evaluate(cell, unit_points, patch.shapes);
      patch.cell = cell;
      patch.nodes.assign(nodes(cell).begin(), nodes(cell).end());
      patch.cell_size = std::cbrt(box.volume());
      result.push_back(std::move(patch));
    }
    return result;
  }

  std::optional<std::vector<unsigned int>> Immersed::face_nodes(const Piece &piece) const
  {
    const Cell &cell       = cells_[piece.cell];
    const Box box          = lattice_.box(cell.place);
    const Direction normal = body_.surface().normal(piece.triangle);
    unsigned int axis      = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (std::abs(normal[d]) > std::abs(normal[axis]))
        axis = d;
    const bool is_upper = normal[axis] > 0;
    const double face   = is_upper ? box.upper_bound(axis) : box.lower_bound(axis);
    for (const Point &corner : body_.surface().corners(piece.triangle))
      if (std::abs(corner[axis] - face) > 1e-8 * box.side_length(axis))
        return {};

    std::vector<unsigned int> result;
    const auto patch_nodes = nodes(piece.cell);
    for (unsigned int i = 0; i < shapes_.n_nodes(); ++i)
      if (shapes_.node(i)[axis] == (is_upper ? 1. : 0.))
      {
        if (!cell.has_hanging())
          result.push_back(patch_nodes[i]);
        else
          for (unsigned int m = 0; m < patch_nodes.size(); ++m)
            if (condensations_[cell.hanging + i * patch_nodes.size() + m] != 0)
              result.push_back(patch_nodes[m]);
      }
    return result;
  }

  std::optional<std::vector<unsigned int>> Immersed::nodes_on(const Region &region) const
  {
    double lost;
    Vector is_on           = make_vector();
    unsigned int all_faces = 1;
    for (const Piece &piece : pieces(triangles_of(region), lost))
      if (const auto face = face_nodes(piece))
        for (const unsigned int node : *face)
          is_on.local_element(3 * node) = 1;
      else
        all_faces = 0;
    if (lost > 0 || dealii::Utilities::MPI::min(all_faces, communicator()) == 0)
      return {};

    is_on.compress(dealii::VectorOperation::add);
    is_on.update_ghost_values();
    std::vector<unsigned int> result;
    for (unsigned int node = 0; node < node_positions_.size(); ++node)
      if (is_on.local_element(3 * node) > 0)
        result.push_back(node);
    return result;
  }
} // namespace softcell
