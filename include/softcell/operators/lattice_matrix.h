// SPDX-License-Identifier: LGPL-2.1-or-later
// What couples neighbouring nodes of a lattice beside the body's own stiffness: supports.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/operators/lattice_unknowns.h>

#include <array>
#include <vector>

namespace softcell
{
  /// A sparse matrix of 3 x 3 blocks between nodes of common cells, most of whose rows are empty.
  template <class Real>
  class LatticeMatrix
  {
  public:
    LatticeMatrix() = default;

    /// @param matrix   complete on this rank, which is alone.
    /// @param entries  of the matrix's nodes, see CellLattice.
    LatticeMatrix(const BlockMatrix &matrix,
                  const std::vector<std::size_t> &entries,
                  const NodeLattice &nodes);

    /// P^T A P with coarse.interpolate() as P: the same in coarse unknowns.
    LatticeMatrix(const LatticeMatrix &fine,
                  const LatticeUnknowns &fine_unknowns,
                  const NodeLattice &nodes);

    /// The same numbers in another precision.
    template <class OtherReal>
    explicit LatticeMatrix(const LatticeMatrix<OtherReal> &other);

    /// y += A x
    void add_product(LatticeVector<Real> &y, const LatticeVector<Real> &x) const;

    /// Adds the symmetric parts of the diagonal blocks.
    void add_diagonal(LatticeBlocks<Real> &blocks) const;

    /// Units: byte
    std::size_t memory() const;

  private:
    template <class>
    friend class LatticeMatrix;

    using Block = std::array<Real, 9>; // row by row

    /// Row by row, the blocks of a node and its 26 neighbours.
    using Stencil = std::array<std::array<double, 9>, 27>;

    void append(std::size_t node, const Stencil &stencil, const NodeLattice &nodes);

    std::vector<std::size_t> nodes_;    // (n_rows)
    std::vector<std::size_t> row_ends_; // (n_rows) in columns_
    std::vector<std::size_t> columns_;  // (n_blocks) nodes
    std::vector<Block> blocks_;         // (n_blocks)
  };
} // namespace softcell
