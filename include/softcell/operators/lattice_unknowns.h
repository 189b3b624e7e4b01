// SPDX-License-Identifier: LGPL-2.1-or-later
// The free unknowns of a lattice, and what goes between a lattice and the next coarser one.
#pragma once

#include <softcell/operators/uniform_cells.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace softcell
{
  /// The cells with twice the edges, from the same lower corner on; where the number of cells along
  /// an axis is odd, the last ones reach beyond them.
  ///
  /// An octant of a coarse cell is a cell of the finer lattice, whose volume its Gauss point gets:
  /// so these are weighted cells of the same body. Mechanisms among them are steadied, since a
  /// coarsest grid that has one is nearly singular.
  CellLattice coarse_cells(const CellLattice &fine);

  /// The nodes of a body's cells, and which of their unknowns are free.
  ///
  /// A field of the unknowns is 0 in all that are not free, and where no cell is. On a coarse
  /// lattice an unknown is free if less than half of its trilinear function's values at the nodes
  /// of the finer lattice belong to unknowns that are not.
  class LatticeUnknowns
  {
  public:
    /// @param held  entries of a LatticeVector that are not free.
    LatticeUnknowns(const CellLattice &cells, const std::vector<std::size_t> &held);

    /// Those of coarse_cells().
    LatticeUnknowns(const CellLattice &coarse, const LatticeUnknowns &fine);

    const NodeLattice &nodes() const
    {
      return nodes_;
    }
    bool has_cell(const std::size_t node) const
    {
      return flags_[node] != 0;
    }
    bool is_free(const std::size_t node, const unsigned int c) const
    {
      return (flags_[node] >> c & 1) != 0;
    }
    /// Entries of all free unknowns.
    std::vector<std::size_t> free_entries() const;

    /// Calls f(begin, end) for runs of nodes along x that hold all nodes with cells, by threads.
    template <class F>
    void for_each_run(const F &f) const
    {
#pragma omp parallel for schedule(static)
      for (const auto &run : runs_)
        f(run.first, run.second);
    }

    /// Calls f(an entry of y, that of x) for all entries in the runs.
    template <class Y, class X, class F>
    void for_each(LatticeVector<Y> &y, const LatticeVector<X> &x, const F &f) const
    {
      for_each_run([&](const std::size_t begin, const std::size_t end) {
        for (unsigned int c = 0; c < dim; ++c)
        {
          Y *const y_c       = y.component(c);
          const X *const x_c = x.component(c);
#pragma omp simd
          for (std::size_t i = begin; i < end; ++i)
            f(y_c[i], x_c[i]);
        }
      });
    }

    /// The sum of x y, the same for any number of threads.
    template <class Real>
    double dot(const LatticeVector<Real> &x, const LatticeVector<Real> &y) const;

    /// The sum of m x y, with m of each node.
    template <class Real>
    double dot(const LatticeVector<Real> &x,
               const LatticeVector<Real> &y,
               const LatticeField<Real, 1> &m) const;

    /// Sets to 0 what is not free but in the runs.
    template <class Real>
    void hold(LatticeVector<Real> &x) const
    {
      for (const std::size_t entry : held_)
        x.entries()[entry] = 0;
    }

    /// fine = the trilinear function of `coarse`, a field on the coarser lattice, at the free
    /// unknowns.
    template <class Real>
    void interpolate(const LatticeVector<Real> &coarse, LatticeVector<Real> &fine) const;

    /// The transpose of the finer lattice's interpolate(), at the free unknowns.
    template <class Real>
    void sum_up(const LatticeVector<Real> &fine, LatticeVector<Real> &coarse) const;

    /// A displacement of the finer lattice as one of this: its values where it has any, and
    /// elsewhere what linear functions through neighbours in line give on the average.
    template <class Real>
    void take(const LatticeUnknowns &fine,
              const LatticeVector<Real> &u_fine,
              LatticeVector<Real> &u) const;

    /// Smooths a displacement about cells with a small det F, until it is above `smallest`
    /// everywhere or a number of sweeps is over.
    /// @param spacing  edges of a cell. Units: m
    template <class Real>
    void untangle(const Direction &spacing, double smallest, LatticeVector<Real> &u) const;

  private:
    template <class F>
    double sum(const F &term) const;
    template <class Real>
    bool is_tangled(const std::size_t (&corners)[8],
                    const Direction &spacing,
                    double smallest,
                    const LatticeVector<Real> &u) const;
    void mark_nodes(const CellLattice &cells);
    void find_runs();

    static constexpr std::uint8_t cell = 8, all_free = 7;

    NodeLattice nodes_;
    std::vector<std::uint8_t> flags_; // (nodes) bits: cell, and components that are free
    std::vector<std::pair<std::size_t, std::size_t>> runs_; // first node and end
    std::vector<std::size_t> held_;                         // entries of a LatticeVector
  };
} // namespace softcell
