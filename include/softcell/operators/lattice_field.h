// SPDX-License-Identifier: LGPL-2.1-or-later
// Unknowns of the matrix-free operators: arrays over the nodes of a lattice.
#pragma once

#include <softcell/base/types.h>

#include <deal.II/base/aligned_vector.h>

#include <array>
#include <cstddef>

namespace softcell
{
  /// The (n_x + 1)(n_y + 1)(n_z + 1) nodes of a box of congruent cells, laid out for packs of
  /// consecutive nodes along x.
  ///
  /// A pack may begin at any node and reach beyond the end of its row into the next one, or beyond
  /// the last row into the padding of its plane: what it writes there must be what it read.
  class NodeLattice
  {
  public:
    /// Entries of the longest pack.
    static constexpr std::size_t max_width = 16;

    explicit NodeLattice(const std::array<int, 3> &n_cells) : n_cells_(n_cells) {}

    const std::array<int, 3> &n_cells() const
    {
      return n_cells_;
    }
    /// From a node to the next one along y, in entries.
    std::size_t row() const
    {
      return (n_cells_[0] + 8) / 8 * 8;
    }
    /// From a node to the next one along z.
    std::size_t plane() const
    {
      return row() * (n_cells_[1] + 1) + max_width;
    }
    /// Entries of one component, with padding.
    std::size_t size() const
    {
      return (plane() * (n_cells_[2] + 1) + max_width - 1) / max_width * max_width;
    }
    std::size_t entry(const int i, const int j, const int k) const
    {
      return i + row() * j + plane() * k;
    }
    bool operator==(const NodeLattice &other) const
    {
      return n_cells_ == other.n_cells_;
    }

  private:
    std::array<int, 3> n_cells_;
  };

  /// `components` numbers for each node of a lattice, component after component, each aligned to
  /// 64 bytes. Entries that belong to no node, or to one without cells, are 0 and stay so under all
  /// operators: sums over all entries are sums over the unknowns.
  template <class Real, unsigned int components>
  class LatticeField
  {
  public:
    /// Zero everywhere.
    explicit LatticeField(const NodeLattice &lattice)
        : lattice_(lattice), entries_(components * lattice.size())
    {
    }

    const NodeLattice &lattice() const
    {
      return lattice_;
    }
    static constexpr unsigned int n_components()
    {
      return components;
    }
    Real *component(const unsigned int c)
    {
      return entries_.data() + c * lattice_.size();
    }
    const Real *component(const unsigned int c) const
    {
      return entries_.data() + c * lattice_.size();
    }
    /// All components, (n_components, lattice().size()).
    View<Real> entries()
    {
      return {entries_.data(), entries_.size()};
    }
    View<const Real> entries() const
    {
      return {entries_.data(), entries_.size()};
    }

  private:
    NodeLattice lattice_;
    dealii::AlignedVector<Real> entries_;
  };

  /// A displacement or a force.
  template <class Real>
  using LatticeVector = LatticeField<Real, 3>;

  /// Symmetric 3 x 3 blocks, in the order xx, yy, zz, yz, xz, xy.
  template <class Real>
  using LatticeBlocks = LatticeField<Real, 6>;
} // namespace softcell
