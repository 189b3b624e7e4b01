// SPDX-License-Identifier: LGPL-2.1-or-later
// Finite elements on conforming meshes: tetrahedra P1, P2 and hexahedra Q1, Q2, ...

#include <softcell/discretization/fitted.h>

#include "fitted_cells.h"

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

#include <cmath>
#include <limits>
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

  Fitted::Fitted(MPI_Comm communicator,
                 const Mesh &mesh,
                 const unsigned int degree,
                 const Body &body)
      : cells_(std::make_unique<FittedCells>(mesh, degree, node_positions_))
  {
    const FiniteElement<3> &element = *cells_->reference.element;
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
    std::vector<types::global_dof_index> numbers(cells_->n_nodes());
    node_positions_.resize((partitioner_->locally_owned_size() + partitioner_->n_ghost_indices()) /
                           3);
    for (const auto &cell : numbering.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        places.reinit(cell);
        cell->get_dof_indices(numbers);
        for (unsigned int i = 0; i < numbers.size(); ++i)
        {
          cells_->nodes.push_back(partitioner_->global_to_local(3 * numbers[i]) / 3);
          node_positions_[cells_->nodes.back()] = places.quadrature_point(i);
        }
        cells_->labels.push_back(body.n_labels() > 1 ? body.label(cell->center()) : 0);
      }
    cells_->add_faces(triangulation, body, !mesh.face_patches.empty());
    cells_->measure(communicator);
  }

  Fitted::~Fitted() = default;

  Size Fitted::size() const
  {
    Size size     = cells_->size;
    size.unknowns = partitioner_->size();
    return size;
  }

  unsigned int Fitted::degree() const
  {
    return cells_->reference.element->degree;
  }

  unsigned int Fitted::n_patches() const
  {
    return cells_->labels.size();
  }

  Patch Fitted::patch(const unsigned int i, PatchStorage &storage) const
  {
    const ShapeTable &reference = cells_->reference.shapes;
    Patch patch;
    patch.nodes    = cells_->nodes_of(i);
    storage.shapes = reference;
    storage.weights.resize(reference.n_points);
    for (unsigned int q = 0; q < reference.n_points; ++q)
    {
      const Tensor<2, 3> J = cells_->jacobian(patch.nodes, reference.gradient(q));
      storage.weights[q]   = cells_->reference.rule.weight(q) * determinant(J);
      cells_->transform(J, reference.gradient(q),
                        storage.shapes.gradients.data() + q * 3 * reference.n_nodes);
    }
    patch.weights = View<const double>(storage.weights.data(), storage.weights.size());
    patch.shapes  = &storage.shapes;
    patch.labels  = View<const unsigned char>(&cells_->labels[i], 1);
    return patch;
  }

  void Fitted::patch_points(const unsigned int i, std::vector<Point> &points) const
  {
    points.resize(cells_->reference.rule.size());
    for (unsigned int q = 0; q < points.size(); ++q)
      points[q] = cells_->position(cells_->nodes_of(i), cells_->reference.shapes.value(q));
  }

  std::vector<SurfacePatch> Fitted::surface_patches(const Region &region) const
  {
    std::vector<SurfacePatch> result;
    for (const FittedCells::Face *face : cells_->faces_in(region, communicator()))
      result.push_back(cells_->surface_patch(*face));
    return result;
  }

  std::optional<std::vector<unsigned int>> Fitted::nodes_on(const Region &region) const
  {
    Vector marks = make_vector();
    for (const FittedCells::Face *face : cells_->faces_in(region, communicator()))
      for (const unsigned int i : cells_->reference.faces[face->number].nodes)
        marks.local_element(3 * cells_->nodes_of(face->cell)[i]) = 1;
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
    Claim claim{reach, std::numeric_limits<double>::lowest()};
    const auto &corners    = cells_->box.get_boundary_points();
    const double round_off = 1e-10 * corners.first.distance(corners.second);
    // Ever more boxes around X, until the next one is farther than the cell that was found. Within
    // a cell, away from its faces, no other cell has a claim, even if it is ten times as large.
    bool is_within  = false;
    double next_box = 0;
    for (unsigned int n = 8; next_box <= claim.distance + round_off && !is_within; n *= 8)
    {
      std::vector<std::pair<Box, unsigned int>> boxes;
      cells_->tree.query(index::nearest(X, n), std::back_inserter(boxes));
      next_box = boxes.size() < n ? std::numeric_limits<double>::infinity() : 0;
      for (const auto &[box, cell] : boxes)
      {
        const double box_distance = boost::geometry::distance(X, box);
        next_box                  = std::max(next_box, box_distance);
        if (box_distance > claim.distance + round_off)
          continue;
        const auto [xi, outside] = cells_->locate(cell, X);
        const Claim other{outside, precedence_of(cells_->centre(cell))};
        if (!other.counts_before(claim, round_off))
          continue;
        best      = {xi, cell};
        claim     = other;
        is_within = cells_->reference.element->reference_cell().contains_point(
          xi, -10 * FittedCells::round_off);
        if (is_within)
          break;
      }
    }
    if (!best)
      return {};

    const auto [xi, cell] = *best;
    const auto nodes      = cells_->nodes_of(cell);
    ShapeTable here       = cells_->reference.shapes_at({xi});
    PointShapes result;
    result.nodes.assign(nodes.begin(), nodes.end());
    result.gradients.resize(3 * nodes.size());
    cells_->transform(cells_->jacobian(nodes, here.gradient(0)), here.gradient(0),
                      result.gradients.data());
    result.values = std::move(here.values);
    result.claim  = claim;
    return result;
  }

  Box Fitted::owned_box() const
  {
    return cells_->owned_box;
  }

  DrawnCells Fitted::drawn_cells() const
  {
    const unsigned int n   = cells_->n_nodes();
    const bool tetrahedron = cells_->reference.is_tetrahedron();
    const int p            = degree();
    const int order[]      = {p, p, p, int(n)};

    // VTK numbers the nodes of tetrahedra as we do.
    std::vector<unsigned int> node_of_vtk(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      const Point xi      = p * cells_->reference.element->unit_support_point(i);
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
        result.connectivity.push_back(cells_->nodes_of(cell)[i]);
      result.offsets.push_back(result.connectivity.size());
      result.patches.push_back(cell);
    }
    result.points = node_positions_;
    for (unsigned int node = 0; node < result.points.size(); ++node)
      result.shapes.push_back({{node}, {1.}, {}, {}});
    return result;
  }
} // namespace softcell
