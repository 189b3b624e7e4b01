// SPDX-License-Identifier: LGPL-2.1-or-later
// Geometry of a conforming mesh's cells and boundary faces.

#include "fitted_cells.h"

#include <softcell/base/exceptions.h>
#include <softcell/geometry/surface.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace softcell
{
  using namespace dealii;

  Point FittedCells::position(const View<const unsigned int> &cell, const double *N) const
  {
    Point X;
    for (unsigned int i = 0; i < cell.size(); ++i)
      X += N[i] * positions[cell[i]];
    return X;
  }

  Point FittedCells::centre(const unsigned int cell) const
  {
    Point X;
    for (const unsigned int node : nodes_of(cell))
      X += positions[node] / n_nodes();
    return X;
  }

  Tensor<2, 3> FittedCells::jacobian(const View<const unsigned int> &cell, const double *dN) const
  {
    Tensor<2, 3> J;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int i = 0; i < cell.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          J[c][d] += positions[cell[i]][c] * dN[d * cell.size() + i];
    return J;
  }

  void FittedCells::transform(const Tensor<2, 3> &J, const double *dN, double *gradients) const
  {
    const Tensor<2, 3> inverse = invert(J);
    const unsigned int n       = n_nodes();
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int i = 0; i < n; ++i)
        gradients[c * n + i] =
          dN[i] * inverse[0][c] + dN[n + i] * inverse[1][c] + dN[2 * n + i] * inverse[2][c];
  }

  Direction FittedCells::area_vector(const View<const unsigned int> &cell,
                                     const ReferenceFace &face,
                                     const double *dN) const
  {
    const Tensor<2, 3> J = jacobian(cell, dN);
    return cross_product_3d(J * face.tangents[0], J * face.tangents[1]);
  }

  double FittedCells::volume(const unsigned int cell) const
  {
    double result = 0;
    for (unsigned int q = 0; q < reference.rule.size(); ++q)
      result += reference.rule.weight(q) *
                determinant(jacobian(nodes_of(cell), reference.shapes.gradient(q)));
    return result;
  }

  void FittedCells::add_faces(const parallel::shared::Triangulation<3> &triangulation,
                              const Body &body,
                              const bool patches_known)
  {
    unsigned int number = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
          {
            const ReferenceFace &shape = reference.faces[f];
            const auto cell_nodes      = nodes_of(number);
            Face face{number, f, 0, {}, {}};
            face.centre = position(cell_nodes, shape.centre_shape.value(0));
            face.normal = area_vector(cell_nodes, shape, shape.centre_shape.gradient(0));
            face.normal /= face.normal.norm();
            face.patch = patches_known
                           ? cell->face(f)->boundary_id()
                           : body.surface().patches()[body.surface().nearest(face.centre).second];
            faces.push_back(face);
          }
        ++number;
      }
  }

  void FittedCells::measure(MPI_Comm communicator)
  {
    // Curved cells bulge out of the box of their nodes.
    const double margin = n_nodes() > 8 ? 0.1 : 1e-9;
    std::vector<std::pair<Box, unsigned int>> boxes;
    unsigned int n_bad    = 0;
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> lowest(3, infinity), highest(3, -infinity);
    for (unsigned int cell = 0; cell < labels.size(); ++cell)
    {
      std::vector<Point> points;
      for (const unsigned int i : nodes_of(cell))
        points.push_back(positions[i]);
      Box cell_box(points);
      for (unsigned int d = 0; d < 3; ++d)
      {
        lowest[d]  = std::min(lowest[d], cell_box.lower_bound(d));
        highest[d] = std::max(highest[d], cell_box.upper_bound(d));
      }
      cell_box.extend(margin * (points[0] - points[1]).norm());
      boxes.emplace_back(cell_box, cell);

      bool good = true;
      for (unsigned int q = 0; q < reference.rule.size(); ++q)
        good &= determinant(jacobian(nodes_of(cell), reference.shapes.gradient(q))) > 0;
      n_bad += !good;
    }
    tree = pack_rtree(boxes);

    const auto box_of = [](const std::vector<double> &a, const std::vector<double> &b) {
      return Box({Point(a[0], a[1], a[2]), Point(b[0], b[1], b[2])});
    };
    if (!labels.empty())
      owned_box = box_of(lowest, highest);
    Utilities::MPI::min(lowest, communicator, lowest);
    Utilities::MPI::max(highest, communicator, highest);
    box = box_of(lowest, highest);

    size.cells              = Utilities::MPI::sum(labels.size(), communicator);
    size.integration_points = size.cells * reference.rule.size();
    n_faces                 = Utilities::MPI::sum(faces.size(), communicator);
    n_bad                   = Utilities::MPI::sum(n_bad, communicator);
    if (n_bad > 0)
      throw BadInput(std::to_string(n_bad) + " of the mesh's " + std::to_string(size.cells) +
                     " cells are inside out or have no volume; mesh the body anew with another "
                     "Discretization/Mesh size, or mend the Discretization/Mesh file.");
  }

  std::vector<const FittedCells::Face *> FittedCells::faces_in(const Region &region,
                                                               MPI_Comm communicator) const
  {
    std::vector<const Face *> result;
    for (const Face &face : faces)
      if (region.contains(face.centre, face.normal, face.patch))
        result.push_back(&face);
    if (Utilities::MPI::sum(result.size(), communicator) == 0)
    {
      std::ostringstream text;
      text << "Regions/" << region.name() << " selects none of the " << n_faces
           << " boundary faces of the mesh, which lies in" << std::setprecision(4);
      for (unsigned int d = 0; d < 3; ++d)
        text << (d == 0 ? " " : ", ") << box.lower_bound(d) << " <= "
             << "xyz"[d] << " <= " << box.upper_bound(d);
      throw BadInput(text.str() + " (m); a face counts by its centre, so widen the condition.");
    }
    return result;
  }

  SurfacePatch FittedCells::surface_patch(const Face &face) const
  {
    const auto cell            = nodes_of(face.cell);
    const ReferenceFace &shape = reference.faces[face.number];
    const Quadrature<2> &rule  = reference.face_rule;
    SurfacePatch result;
    result.cell = face.cell;
    result.nodes.assign(cell.begin(), cell.end());
    result.shapes = shape.shapes;
    result.labels.assign(rule.size(), labels[face.cell]);
    double area = 0;
    for (unsigned int q = 0; q < rule.size(); ++q)
    {
      const double *dN  = shape.shapes.gradient(q);
      const Direction a = area_vector(cell, shape, dN);
      result.points.push_back(position(cell, shape.shapes.value(q)));
      result.normals.push_back(a / a.norm());
      result.weights.push_back(rule.weight(q) * a.norm());
      transform(jacobian(cell, dN), dN, result.shapes.gradients.data() + q * 3 * n_nodes());
      area += result.weights.back();
    }
    // The cell's height over the face.
    result.cell_size = (reference.is_tetrahedron() ? 3 : 1) * volume(face.cell) / area;
    return result;
  }

  std::pair<Point, double> FittedCells::locate(const unsigned int cell, const Point &X) const
  {
    const ReferenceCell shape = reference.element->reference_cell();
    const auto nodes_here     = nodes_of(cell);
    Point xi                  = shape.barycenter<3>();
    bool converged            = false;
    for (unsigned int iteration = 0; iteration < 20 && !converged; ++iteration)
    {
      const ShapeTable here = reference.shapes_at({xi});
      const Tensor<2, 3> J  = jacobian(nodes_here, here.gradient(0));
      if (!(determinant(J) > 0))
        break;
      const Direction step = invert(J) * (X - position(nodes_here, here.value(0)));
      xi += step;
      converged = step.norm() < 1e-12 * (1 + xi.norm());
    }

    Point inside = xi;
    for (unsigned int d = 0; d < 3; ++d)
      inside[d] = std::max(inside[d], 0.);
    if (reference.is_tetrahedron())
      inside /= std::max(inside[0] + inside[1] + inside[2], 1.);
    else
      for (unsigned int d = 0; d < 3; ++d)
        inside[d] = std::min(inside[d], 1.);
    if (converged && inside.distance(xi) < round_off)
      return {xi, 0.};
    const ShapeTable there = reference.shapes_at({inside});
    return {converged ? xi : inside, X.distance(position(nodes_here, there.value(0)))};
  }
} // namespace softcell
