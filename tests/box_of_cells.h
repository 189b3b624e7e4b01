// SPDX-License-Identifier: LGPL-2.1-or-later
// A box of trilinear hexahedra in slabs along z, one slab of cells per rank: a discretization to
// test operators, loads and studies with.
#pragma once

#include <softcell/discretization/discretization.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace softcell
{
  /// Nodes are numbered x fastest, z slowest; a rank owns its cells' nodes but those on top, which
  /// belong to the next rank that has cells.
  class BoxOfCells : public Discretization
  {
  public:
    /// @param is_fitted false: no strong displacements, as if the cells were a background grid.
    BoxOfCells(const std::array<unsigned int, 3> &cells,
               const Point &size,
               const MPI_Comm communicator = MPI_COMM_SELF,
               const bool is_fitted        = true)
        : cells_(cells), size_(size), is_fitted_(is_fitted)
    {
      const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator),
                         n = dealii::Utilities::MPI::n_mpi_processes(communicator), nz = cells[2];
      first_layer_                 = nz * rank / n;
      end_layer_                   = nz * (rank + 1) / n;
      const unsigned int plane     = (cells[0] + 1) * (cells[1] + 1);
      const bool has_cells         = first_layer_ < end_layer_;
      const bool owns_top          = has_cells && end_layer_ == nz;
      const unsigned int owned_end = plane * (end_layer_ + owns_top);
      dealii::IndexSet owned(3 * plane * (nz + 1)), ghosts(3 * plane * (nz + 1));
      owned.add_range(3 * plane * first_layer_, 3 * owned_end);
      if (has_cells && !owns_top)
        ghosts.add_range(3 * owned_end, 3 * (owned_end + plane));
      partitioner_ = std::make_shared<Partitioner>(owned, ghosts, communicator);
      if (has_cells)
        for (unsigned int k = first_layer_; k <= end_layer_; ++k)
          for (unsigned int j = 0; j <= cells[1]; ++j)
            for (unsigned int i = 0; i <= cells[0]; ++i)
              node_positions_.emplace_back(i * h(0), j * h(1), k * h(2));
      for (const double x : gauss)
        for (const double y : gauss)
          for (const double z : gauss)
            gauss_points_.emplace_back(z, y, x);
      table_.resize(8, 8);
      for (unsigned int q = 0; q < 8; ++q)
        fill(gauss_points_[q], table_, q);
    }

    Size size() const override
    {
      const std::size_t n = cells_[0] * cells_[1] * cells_[2];
      return {n, 0, partitioner_->size(), 8 * n};
    }
    unsigned int degree() const override
    {
      return 1;
    }
    unsigned int n_patches() const override
    {
      return cells_[0] * cells_[1] * (end_layer_ - first_layer_);
    }

    Patch patch(const unsigned int i, PatchStorage &storage) const override
    {
      storage.nodes = cell_nodes(cell(i));
      storage.weights.assign(8, h(0) * h(1) * h(2) / 8);
      storage.labels = {0};
      return {storage.nodes, storage.weights, &table_, storage.labels};
    }

    void patch_points(const unsigned int i, std::vector<Point> &points) const override
    {
      points.clear();
      for (const Point &xi : gauss_points_)
        points.push_back(position(cell(i), xi));
    }

    std::vector<SurfacePatch> surface_patches(const Region &region) const override
    {
      std::vector<SurfacePatch> patches;
      for_faces(region, [&](const auto &c, const unsigned int axis, const unsigned int side) {
        SurfacePatch patch;
        patch.cell      = c[0] + cells_[0] * (c[1] + cells_[1] * (c[2] - first_layer_));
        patch.nodes     = cell_nodes(c);
        patch.cell_size = h(axis);
        patch.labels    = {0, 0, 0, 0};
        patch.shapes.resize(4, 8);
        Direction normal;
        normal[axis] = side == 0 ? -1 : 1;
        for (unsigned int q = 0; q < 4; ++q)
        {
          Point xi;
          xi[axis]           = side;
          xi[(axis + 1) % 3] = gauss[q % 2];
          xi[(axis + 2) % 3] = gauss[q / 2];
          fill(xi, patch.shapes, q);
          patch.points.push_back(position(c, xi));
          patch.normals.push_back(normal);
          patch.weights.push_back(h((axis + 1) % 3) * h((axis + 2) % 3) / 4);
        }
        patches.push_back(std::move(patch));
      });
      return patches;
    }

    std::optional<std::vector<unsigned int>> nodes_on(const Region &region) const override
    {
      if (!is_fitted_)
        return {};
      std::vector<unsigned int> nodes;
      for_faces(region, [&](const auto &c, const unsigned int axis, const unsigned int side) {
        const auto corners = cell_nodes(c);
        for (unsigned int v = 0; v < 8; ++v)
          if (((v >> axis) & 1) == side)
            nodes.push_back(corners[v]);
      });
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }

    std::optional<PointShapes> shapes_at(const Point &X, const double reach) const override
    {
      if (n_patches() == 0)
        return {};
      std::array<unsigned int, 3> c;
      Point xi, nearest;
      for (unsigned int d = 0; d < 3; ++d)
      {
        const double first = d == 2 ? first_layer_ : 0, end = d == 2 ? end_layer_ : cells_[d];
        c[d]       = std::clamp(std::floor(X[d] / h(d)), first, end - 1);
        xi[d]      = X[d] / h(d) - c[d];
        nearest[d] = std::clamp(X[d], first * h(d), end * h(d));
      }
      if (X.distance(nearest) > reach)
        return {};
      ShapeTable table;
      table.resize(1, 8);
      fill(xi, table, 0);
      return PointShapes{
        cell_nodes(c), table.values, table.gradients,
        Claim{X.distance(nearest), precedence_of(position(c, Point(0.5, 0.5, 0.5)))}};
    }

    Box owned_box() const override
    {
      return Box({Point(0, 0, first_layer_ * h(2)), Point(size_[0], size_[1], end_layer_ * h(2))});
    }

    DrawnCells drawn_cells() const override
    {
      return {};
    }

  private:
    static constexpr std::array<double, 2> gauss = {{0.21132486540518712, 0.7886751345948129}};

    double h(const unsigned int d) const
    {
      return size_[d] / cells_[d];
    }

    std::array<unsigned int, 3> cell(const unsigned int i) const
    {
      return {
        {i % cells_[0], i / cells_[0] % cells_[1], i / (cells_[0] * cells_[1]) + first_layer_}};
    }

    Point position(const std::array<unsigned int, 3> &c, const Point &xi) const
    {
      return Point((c[0] + xi[0]) * h(0), (c[1] + xi[1]) * h(1), (c[2] + xi[2]) * h(2));
    }

    std::vector<unsigned int> cell_nodes(const std::array<unsigned int, 3> &c) const
    {
      std::vector<unsigned int> nodes;
      for (unsigned int v = 0; v < 8; ++v)
        nodes.push_back((c[0] + v % 2) +
                        (cells_[0] + 1) *
                          ((c[1] + v / 2 % 2) + (cells_[1] + 1) * (c[2] + v / 4 - first_layer_)));
      return nodes;
    }

    /// Shapes at xi in the unit cube as row q of the table.
    void fill(const Point &xi, ShapeTable &table, const unsigned int q) const
    {
      for (unsigned int v = 0; v < 8; ++v)
      {
        std::array<double, 3> N, dN;
        for (unsigned int d = 0; d < 3; ++d)
        {
          const bool upper = (v >> d) & 1;
          N[d]             = upper ? xi[d] : 1 - xi[d];
          dN[d]            = (upper ? 1 : -1) / h(d);
        }
        table.values[8 * q + v] = N[0] * N[1] * N[2];
        for (unsigned int d = 0; d < 3; ++d)
          table.gradients[(3 * q + d) * 8 + v] = dN[d] * N[(d + 1) % 3] * N[(d + 2) % 3];
      }
    }

    /// Calls f(cell, axis, side) for this rank's boundary faces in the region.
    template <class Function>
    void for_faces(const Region &region, const Function &f) const
    {
      for (unsigned int i = 0; i < n_patches(); ++i)
        for (unsigned int axis = 0; axis < 3; ++axis)
          for (unsigned int side = 0; side < 2; ++side)
          {
            const auto c = cell(i);
            if (c[axis] != (side == 0 ? 0 : cells_[axis] - 1))
              continue;
            Point xi(0.5, 0.5, 0.5);
            xi[axis] = side;
            Direction normal;
            normal[axis] = side == 0 ? -1 : 1;
            if (region.contains(position(c, xi), normal, 0))
              f(c, axis, side);
          }
    }

    std::array<unsigned int, 3> cells_;
    Point size_;
    bool is_fitted_;
    unsigned int first_layer_, end_layer_;
    std::vector<Point> gauss_points_;
    ShapeTable table_;
  };

  /// The displacement f(X) at the nodes, with ghost values.
  template <class Function>
  Vector nodal_values(const Discretization &discretization, const Function &f)
  {
    Vector u = discretization.make_vector();
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      u.local_element(i) = f(discretization.node_positions()[i / 3])[i % 3];
    u.update_ghost_values();
    return u;
  }
} // namespace softcell
