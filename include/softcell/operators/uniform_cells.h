// SPDX-License-Identifier: LGPL-2.1-or-later
// Congruent trilinear cells of a background grid in their compact form.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/operators/lattice_field.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace softcell
{
  /// A cell with its own 8 Gauss points, along x first: full or a weighted cell.
  struct GaussCell
  {
    std::array<int, 3> place;      // in the lattice
    std::array<double, 8> weights; // Units: m^3
  };

  /// A cell with points of its own.
  struct PointCell
  {
    std::array<int, 3> place;
    std::vector<double> weights; // (n_points) Units: m^3
    std::vector<Point> points;   // (n_points) in the unit cube
  };

  /// All cells of a body in the box of cells around it.
  struct CellLattice
  {
    NodeLattice nodes;
    Direction spacing; // edges of a cell. Units: m
    std::vector<GaussCell> gauss_cells;
    std::vector<PointCell> point_cells;
    std::vector<std::size_t> entries; // (local nodes of the discretization) in a LatticeField
  };

  /// @throws BadInput unless the discretization consists of cells of one size and material, of
  /// degree 1, with nothing that steadies them, on one rank alone.
  CellLattice cell_lattice(const Discretization &discretization);

  /// The integral of a density over the cells, shared out to the nodes by their shapes: with a mass
  /// density the diagonal of the lumped mass matrix. Nodes without cells get 0.
  template <class Real>
  LatticeField<Real, 1> lumped(double density, const CellLattice &cells);

  template <class Real>
  void copy(const Vector &from, const std::vector<std::size_t> &entries, LatticeVector<Real> &to);

  /// Ghosts are not updated.
  template <class Real>
  void copy(const LatticeVector<Real> &from, const std::vector<std::size_t> &entries, Vector &to);

  /// The cells in packs of W, ordered by layers along z.
  ///
  /// Neighbours along x are loaded at once. A full cell stores nothing, and any other cell of Gauss
  /// points its eight weights. Lanes without a cell have the weights 0.
  template <class Real>
  class UniformCells
  {
  public:
    explicit UniformCells(const CellLattice &cells);
    UniformCells(UniformCells &&) noexcept            = default; // a copy's packs would look into
    UniformCells &operator=(UniformCells &&) noexcept = default; // the original

    /// Cells with Gauss points: W neighbours along x, or W/2 neighbours and W/2 others in the same
    /// layer.
    struct RowPack
    {
      std::size_t lower, upper; // entries of the lowest nodes of both halves' first cells
      bool is_one_row;          // upper follows lower
      std::size_t point;        // number of its first pack of points
      const Real *weights;      // (8, W) Units: m^3; packs of full cells share theirs
      const RowPack *ahead;     // the pack after the next one
    };

    /// Cells from anywhere in a layer with points of their own.
    struct PointPack
    {
      const std::size_t *entries; // (W) of the cells' lowest nodes
      std::size_t point;          // number of its first pack of points
      unsigned int n_points;      // of the cell with most; others have weights 0
      const Real *points;         // (n_points, 4, W) place in the cube [-1, 1]^3 and weight (m^3)
    };

    const NodeLattice &nodes() const
    {
      return nodes_;
    }
    /// Edges of a cell. Units: m
    const std::array<Real, 3> &spacing() const
    {
      return spacing_;
    }
    /// Calls f(entry, n) for runs of entries that hold all nodes of cells in plane k of nodes, and
    /// others.
    template <class F>
    void for_each_run(const int k, const F &f) const
    {
      const int n_rows = nodes_.n_cells()[1] + 1;
      for (int row = k * n_rows; row < (k + 1) * n_rows; ++row)
        if (runs_[row].first < runs_[row].second)
          f(runs_[row].first, runs_[row].second - runs_[row].first);
    }
    /// Packs of points, in all packs of cells.
    std::size_t n_point_packs() const
    {
      return n_points_;
    }
    /// Units: byte
    std::size_t memory() const;

    /// Calls f(pack, layer) for all packs, by several threads (OMP_NUM_THREADS of them) none of
    /// which handles a pack while another one handles a pack with nodes in common. Before a plane
    /// of nodes k is used for the first time, begin_plane(k) is called. What is added to a node is
    /// added in the same order for any number of threads.
    template <class BeginPlane, class F>
    void for_each_pack(const BeginPlane &begin_plane, const F &f) const
    {
      const int n_layers = nodes_.n_cells()[2], n_slabs = std::max(n_layers / slab, 1);
      const auto first = [&](const int s) { return s * n_layers / n_slabs; };
      const auto layer = [&](const int k) {
        for (std::size_t p = row_layers_[k]; p < row_layers_[k + 1]; ++p)
          f(row_packs_[p], k);
        for (std::size_t p = point_layers_[k]; p < point_layers_[k + 1]; ++p)
          f(point_packs_[p], k);
      };
#pragma omp parallel
      {
#pragma omp for schedule(dynamic)
        for (int s = 0; s < n_slabs; ++s) // all layers but the last, which has the next one's nodes
        {
          begin_plane(first(s));
          for (int k = first(s); k < first(s + 1) - 1; ++k)
          {
            begin_plane(k + 1);
            layer(k);
          }
          if (s + 1 == n_slabs)
            begin_plane(n_layers);
        }
#pragma omp for schedule(dynamic)
        for (int s = 0; s < n_slabs; ++s)
          layer(first(s + 1) - 1);
      }
    }

  private:
    /// Layers that a thread takes at once: as few as leave the last ones of two slabs without
    /// common nodes, so that no thread waits for long at the end.
    static constexpr int slab = 2;

    /// @param full  the weights of a full cell. Units: m^3
    void add_row_packs(const std::vector<GaussCell> &cells, double full);
    void add_point_packs(const std::vector<PointCell> &cells);
    /// Takes the nodes of a cell into the runs.
    void add_to_runs(const std::array<int, 3> &place);

    NodeLattice nodes_;
    std::array<Real, 3> spacing_;
    std::size_t n_points_ = 0;
    std::vector<RowPack> row_packs_;
    std::vector<PointPack> point_packs_;
    std::vector<std::size_t> row_layers_, point_layers_;    // (n_layers + 1) first packs
    std::vector<std::pair<std::size_t, std::size_t>> runs_; // (rows of nodes) begin and end
    std::vector<std::size_t> entries_;                      // of the point packs
    dealii::AlignedVector<Real> weights_, points_;
  };
} // namespace softcell
