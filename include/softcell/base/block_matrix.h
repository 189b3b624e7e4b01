// SPDX-License-Identifier: LGPL-2.1-or-later
// The assembled tangent: a sparse matrix of 3 x 3 blocks, one block row per node, distributed by
// rows.
#pragma once

#include <softcell/base/types.h>

#include <memory>
#include <vector>

namespace softcell
{
  /// Symmetric-pattern sparse matrix of 3 x 3 blocks over the nodes of a Partitioner of unknowns.
  ///
  /// While assembling, each rank adds blocks at pairs of its local nodes (owned or ghost);
  /// compress() sends what was added to other ranks' rows to their owners. Then every owned row is
  /// complete.
  class BlockMatrix
  {
  public:
    /// @param couplings  lists of local nodes that all couple with each other, one list per patch
    /// (duplicates cost
    ///                   only time). Collective.
    BlockMatrix(const std::shared_ptr<const Partitioner> &unknowns,
                const std::vector<std::vector<unsigned int>> &couplings);
    ~BlockMatrix();
    BlockMatrix(BlockMatrix &&) noexcept;

    void set_zero();

    /// Adds a dense patch matrix. `values` is (3, n, 3, n): row component, row node, column
    /// component, column node, which is how the patch kernels vectorise.
    void add(View<const unsigned int> nodes, const double *values);

    /// Sends contributions to rows of other ranks and adds what they sent. Collective.
    void compress();

    /// Replaces the owned and ghost rows and columns of these local unknowns (3 * node + c, owned
    /// or ghost) by those of the identity times `diagonal`; call after compress(). Collective.
    void constrain(const std::vector<unsigned int> &local_unknowns, double diagonal);

    /// The diagonal of the owned rows, without ghosts.
    Vector diagonal() const;

    /// y = A x; x may be without ghosts. Collective.
    void vmult(Vector &y, const Vector &x) const;

    /// Compressed rows: block row i holds blocks row_start()[i] .. row_start()[i + 1] with the
    /// global node numbers columns(), ascending, the owned nodes first and the ghost nodes (whose
    /// rows compress() empties) after them. values() has (3, n, 3) numbers for a block row of n
    /// blocks: row component, block, column component. They are thus the values of the matrix of
    /// unknowns in compressed rows, in the form that Trilinos and PETSc store.
    const std::vector<std::size_t> &row_start() const;
    const std::vector<unsigned int> &columns() const;
    const std::vector<double> &values() const;

    const std::shared_ptr<const Partitioner> &partitioner() const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
  };
} // namespace softcell
