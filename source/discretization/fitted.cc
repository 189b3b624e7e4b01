// SPDX-License-Identifier: LGPL-2.1-or-later
// Finite elements on conforming meshes: tetrahedra P1, P2 and hexahedra Q1, Q2, ...
#include <softcell/discretization/fitted.h>

#include "reference_element.h"

#include <softcell/base/exceptions.h>
#include <softcell/geometry/surface.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/numerics/rtree.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <vtkHigherOrderHexahedron.h>

namespace softcell
{
  using namespace dealii;

  namespace
  {
    using Mesher = parallel::shared::Triangulation<3>;

    void fill(Mesher &triangulation, const Mesh &mesh)
    {
      std::vector<CellData<3>> cells;
      for (auto c = mesh.corners.begin(); c != mesh.corners.end(); c += mesh.corners_per_cell)
        cells.emplace_back().vertices.assign(c, c + mesh.corners_per_cell);
      if (mesh.corners_per_cell == 8)
        GridTools::consistently_order_cells(cells);

      SubCellData boundary;
      const unsigned int n = mesh.corners_per_cell / 2 + (mesh.corners_per_cell == 4);
      for (std::size_t f = 0; f < mesh.face_patches.size(); ++f)
      {
        auto &face = boundary.boundary_quads.emplace_back();
        face.vertices.assign(mesh.face_corners.begin() + f * n,
                             mesh.face_corners.begin() + (f + 1) * n);
        face.boundary_id = mesh.face_patches[f];
      }
      triangulation.create_triangulation(mesh.vertices, cells, boundary);

      if (mesh.mantle_radius > 0)
      {
        triangulation.set_manifold(1, CylindricalManifold<3>(2));
        for (const auto &face : triangulation.active_face_iterators())
        {
          bool on_mantle = face->at_boundary();
          for (const unsigned int v : face->vertex_indices())
            on_mantle &= std::abs(std::hypot(face->vertex(v)[0], face->vertex(v)[1]) -
                                  mesh.mantle_radius) < 1e-9 * mesh.mantle_radius;
          if (on_mantle)
            face->set_all_manifold_ids(1);
        }
      }
    }

    /// Of each unknown of three a node, from the nodes.
    std::shared_ptr<const Partitioner>
    unknowns(const IndexSet &owned, const IndexSet &used, MPI_Comm communicator)
    {
      const auto tripled = [](const IndexSet &nodes) {
        IndexSet result(3 * nodes.size());
        for (auto r = nodes.begin_intervals(); r != nodes.end_intervals(); ++r)
          result.add_range(3 * *r->begin(), 3 * (r->last() + 1));
        return result;
      };
      return std::make_shared<const Partitioner>(tripled(owned), tripled(used), communicator);
    }
  } // namespace

  struct Fitted::Data
  {
    struct Face
    {
      unsigned int cell, number, patch;
      Point centre;
      Direction normal;
    };

    const ReferenceElement reference;

    std::vector<unsigned int> nodes;          // (n_cells, n_nodes)
    std::vector<unsigned char> labels;        // (n_cells)
    std::vector<Face> faces;                  // on the boundary
    RTree<std::pair<Box, unsigned int>> tree; // of cells
    Size size;
    Box owned_box, box;
    unsigned int n_faces = 0; // on the boundary, of all ranks
    const std::vector<Point> &positions;

    Data(const Mesh &mesh, const unsigned int degree, const std::vector<Point> &node_positions)
        : reference(mesh.corners_per_cell, degree), positions(node_positions)
    {
    }

    unsigned int n_nodes() const
    {
      return reference.n_nodes();
    }
    View<const unsigned int> nodes_of(const unsigned int cell) const
    {
      return View<const unsigned int>(nodes.data() + std::size_t(cell) * n_nodes(), n_nodes());
    }
    Point position(const View<const unsigned int> &cell, const double *N) const
    {
      Point X;
      for (unsigned int i = 0; i < cell.size(); ++i)
        X += N[i] * positions[cell[i]];
      return X;
    }
    /// J_cd = dX_c / dxi_d
    Tensor<2, 3> jacobian(const View<const unsigned int> &cell, const double *dN) const
    {
      Tensor<2, 3> J;
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int i = 0; i < cell.size(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            J[c][d] += positions[cell[i]][c] * dN[d * cell.size() + i];
      return J;
    }
    /// dN/dX from dN/dxi, both (3, n_nodes).
    void transform(const Tensor<2, 3> &J, const double *dN, double *gradients) const
    {
      const Tensor<2, 3> inverse = invert(J);
      const unsigned int n       = n_nodes();
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < n; ++i)
          gradients[c * n + i] =
            dN[i] * inverse[0][c] + dN[n + i] * inverse[1][c] + dN[2 * n + i] * inverse[2][c];
    }
    /// Normal times what the face's tangents span.
    Direction area_vector(const View<const unsigned int> &cell,
                          const ReferenceFace &face,
                          const double *dN) const
    {
      const Tensor<2, 3> J = jacobian(cell, dN);
      return cross_product_3d(J * face.tangents[0], J * face.tangents[1]);
    }
    double volume(const unsigned int cell) const
    {
      double result = 0;
      for (unsigned int q = 0; q < reference.rule.size(); ++q)
        result += reference.rule.weight(q) *
                  determinant(jacobian(nodes_of(cell), reference.shapes.gradient(q)));
      return result;
    }

    void add_faces(const Mesher &, const Body &, bool patches_known);
    void measure(MPI_Comm communicator);
    std::vector<const Face *> faces_in(const Region &region, MPI_Comm communicator) const;
    SurfacePatch surface_patch(const Face &face) const;
    std::pair<Point, double> locate(unsigned int cell, const Point &X) const;
  };

  Fitted::Fitted(MPI_Comm communicator,
                 const Mesh &mesh,
                 const unsigned int degree,
                 const Body &body)
      : data_(std::make_unique<Data>(mesh, degree, node_positions_))
  {
    const FiniteElement<3> &element = *data_->reference.element;
    Mesher triangulation(communicator, Triangulation<3>::none, true, Mesher::partition_metis);
    fill(triangulation, mesh);
    DoFHandler<3> numbering(triangulation);
    numbering.distribute_dofs(element);
    partitioner_ = unknowns(numbering.locally_owned_dofs(),
                            DoFTools::extract_locally_active_dofs(numbering), communicator);

    std::unique_ptr<Mapping<3>> mapping;
    if (mesh.corners_per_cell == 4)
      mapping = std::make_unique<MappingFE<3>>(FE_SimplexP<3>(1));
    else
      mapping = std::make_unique<MappingQ<3>>(degree);
    FEValues<3> places(*mapping, element, Quadrature<3>(element.get_unit_support_points()),
                       update_quadrature_points);
    std::vector<types::global_dof_index> numbers(data_->n_nodes());
    node_positions_.resize((partitioner_->locally_owned_size() + partitioner_->n_ghost_indices()) /
                           3);
    for (const auto &cell : numbering.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        places.reinit(cell);
        cell->get_dof_indices(numbers);
        for (unsigned int i = 0; i < numbers.size(); ++i)
        {
          data_->nodes.push_back(partitioner_->global_to_local(3 * numbers[i]) / 3);
          node_positions_[data_->nodes.back()] = places.quadrature_point(i);
        }
        data_->labels.push_back(body.n_labels() > 1 ? body.label(cell->center()) : 0);
      }
    data_->add_faces(triangulation, body, !mesh.face_patches.empty());
    data_->measure(communicator);
  }

  Fitted::~Fitted() = default;

  void
  Fitted::Data::add_faces(const Mesher &triangulation, const Body &body, const bool patches_known)
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

  void Fitted::Data::measure(MPI_Comm communicator)
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

  std::vector<const Fitted::Data::Face *> Fitted::Data::faces_in(const Region &region,
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

  SurfacePatch Fitted::Data::surface_patch(const Face &face) const
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

  /// Reference coordinates of X in a cell (Newton), and how far X is outside, measured from the
  /// point of the cell whose reference coordinates are nearest to those.
  std::pair<Point, double> Fitted::Data::locate(const unsigned int cell, const Point &X) const
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
    if (converged && inside.distance(xi) < 1e-10)
      return {xi, 0.};
    const ShapeTable there = reference.shapes_at({inside});
    return {converged ? xi : inside, X.distance(position(nodes_here, there.value(0)))};
  }

  Size Fitted::size() const
  {
    Size size     = data_->size;
    size.unknowns = partitioner_->size();
    return size;
  }

  unsigned int Fitted::degree() const
  {
    return data_->reference.element->degree;
  }

  unsigned int Fitted::n_patches() const
  {
    return data_->labels.size();
  }

  Patch Fitted::patch(const unsigned int i, PatchStorage &storage) const
  {
    const ShapeTable &reference = data_->reference.shapes;
    Patch patch;
    patch.nodes    = data_->nodes_of(i);
    storage.shapes = reference;
    storage.weights.resize(reference.n_points);
    for (unsigned int q = 0; q < reference.n_points; ++q)
    {
      const Tensor<2, 3> J = data_->jacobian(patch.nodes, reference.gradient(q));
      storage.weights[q]   = data_->reference.rule.weight(q) * determinant(J);
      data_->transform(J, reference.gradient(q),
                       storage.shapes.gradients.data() + q * 3 * reference.n_nodes);
    }
    patch.weights = View<const double>(storage.weights.data(), storage.weights.size());
    patch.shapes  = &storage.shapes;
    patch.labels  = View<const unsigned char>(&data_->labels[i], 1);
    return patch;
  }

  void Fitted::patch_points(const unsigned int i, std::vector<Point> &points) const
  {
    points.resize(data_->reference.rule.size());
    for (unsigned int q = 0; q < points.size(); ++q)
      points[q] = data_->position(data_->nodes_of(i), data_->reference.shapes.value(q));
  }

  std::vector<SurfacePatch> Fitted::surface_patches(const Region &region) const
  {
    std::vector<SurfacePatch> result;
    for (const Data::Face *face : data_->faces_in(region, communicator()))
      result.push_back(data_->surface_patch(*face));
    return result;
  }

  std::optional<std::vector<unsigned int>> Fitted::nodes_on(const Region &region) const
  {
    Vector marks = make_vector();
    for (const Data::Face *face : data_->faces_in(region, communicator()))
      for (const unsigned int i : data_->reference.faces[face->number].nodes)
        marks.local_element(3 * data_->nodes_of(face->cell)[i]) = 1;
    // A face is seen by one rank only, its nodes by several.
    marks.compress(VectorOperation::add);
    marks.update_ghost_values();
    std::vector<unsigned int> result;
    for (unsigned int node = 0; node < node_positions_.size(); ++node)
      if (marks.local_element(3 * node) > 0)
        result.push_back(node);
    return result;
  }

  std::optional<PointShapes> Fitted::shapes_at(const Point &X, const double reach) const
  {
    namespace index = boost::geometry::index;
    std::optional<std::pair<Point, unsigned int>> best;
    double distance = reach;
    // Ever more boxes around X, until the next one is farther than the cell that was found.
    double next_box = 0;
    for (unsigned int n = 8; next_box <= distance && !(best && distance == 0); n *= 8)
    {
      std::vector<std::pair<Box, unsigned int>> boxes;
      data_->tree.query(index::nearest(X, n), std::back_inserter(boxes));
      next_box = boxes.size() < n ? std::numeric_limits<double>::infinity() : 0;
      for (const auto &[box, cell] : boxes)
      {
        const double box_distance = boost::geometry::distance(X, box);
        next_box                  = std::max(next_box, box_distance);
        if (box_distance > distance)
          continue;
        const auto [xi, outside] = data_->locate(cell, X);
        if (outside <= distance)
        {
          best     = {xi, cell};
          distance = outside;
        }
      }
    }
    if (!best)
      return {};

    const auto [xi, cell] = *best;
    const auto nodes      = data_->nodes_of(cell);
    ShapeTable here       = data_->reference.shapes_at({xi});
    PointShapes result;
    result.nodes.assign(nodes.begin(), nodes.end());
    result.gradients.resize(3 * nodes.size());
    data_->transform(data_->jacobian(nodes, here.gradient(0)), here.gradient(0),
                     result.gradients.data());
    result.values   = std::move(here.values);
    result.distance = distance;
    return result;
  }

  Box Fitted::owned_box() const
  {
    return data_->owned_box;
  }

  DrawnCells Fitted::drawn_cells() const
  {
    const unsigned int n   = data_->n_nodes();
    const bool tetrahedron = data_->reference.is_tetrahedron();
    const int p            = degree();
    const int order[]      = {p, p, p, int(n)};

    // VTK numbers the nodes of tetrahedra as we do.
    std::vector<unsigned int> node_of_vtk(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      const Point xi      = p * data_->reference.element->unit_support_point(i);
      const auto number   = tetrahedron
                              ? i
                              : vtkHigherOrderHexahedron::PointIndexFromIJK(
                                  std::lround(xi[0]), std::lround(xi[1]), std::lround(xi[2]), order);
      node_of_vtk[number] = i;
    }

    DrawnCells result;
    result.types.assign(n_patches(), tetrahedron ? (p == 1 ? 10 : 24) : (p == 1 ? 12 : 72));
    result.cut_fraction.assign(n_patches(), 1.);
    result.offsets = {0};
    for (unsigned int cell = 0; cell < n_patches(); ++cell)
    {
      for (const unsigned int i : node_of_vtk)
        result.connectivity.push_back(data_->nodes_of(cell)[i]);
      result.offsets.push_back(result.connectivity.size());
      result.patches.push_back(cell);
    }
    result.points = node_positions_;
    for (unsigned int node = 0; node < result.points.size(); ++node)
      result.shapes.push_back({{node}, {1.}, {}, 0.});
    return result;
  }
} // namespace softcell
