// SPDX-License-Identifier: LGPL-2.1-or-later
// The block matrix against a dense one, on any number of ranks.

#include <softcell/base/block_matrix.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{
  using namespace softcell;

  /// A ring of nodes, four to a rank. Patch i, integrated by the owner of node i, couples the nodes
  /// i, i + 1 and i + 6, so that rows of a rank have columns that its own patches never see.
  struct Ring
  {
    static constexpr unsigned int per_rank = 4;
    const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_nodes = per_rank * dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    std::shared_ptr<const Partitioner> unknowns;
    std::vector<std::vector<unsigned int>> patches; // local nodes

    std::array<unsigned int, 3> patch(const unsigned int i) const
    {
      return {{i, (i + 1) % n_nodes, (i + 6) % n_nodes}};
    }

    /// A symmetric matrix that is different for each patch, in the layout of BlockMatrix::add().
    static std::vector<double> patch_values(const unsigned int i)
    {
      std::vector<double> values(81);
      for (unsigned int r = 0; r < 9; ++r)
        for (unsigned int s = 0; s < 9; ++s)
          values[9 * r + s] = std::cos(1. + i + 2. * r * s + r + s) + (r == s ? 12. : 0.);
      return values;
    }

    Ring()
    {
      dealii::IndexSet owned(3 * n_nodes), ghosts(3 * n_nodes);
      owned.add_range(3 * per_rank * rank, 3 * per_rank * (rank + 1));
      for (unsigned int i = per_rank * rank; i < per_rank * (rank + 1); ++i)
        for (const unsigned int node : patch(i))
          ghosts.add_range(3 * node, 3 * node + 3);
      ghosts.subtract_set(owned);
      unknowns = std::make_shared<const Partitioner>(owned, ghosts, MPI_COMM_WORLD);
      for (unsigned int i = per_rank * rank; i < per_rank * (rank + 1); ++i)
      {
        patches.emplace_back();
        for (const unsigned int node : patch(i))
          patches.back().push_back(unknowns->global_to_local(3 * node) / 3);
      }
    }

    BlockMatrix assembled() const
    {
      BlockMatrix matrix(unknowns, patches);
      assemble(matrix);
      return matrix;
    }

    void assemble(BlockMatrix &matrix) const
    {
      for (unsigned int i = 0; i < per_rank; ++i)
        matrix.add(dealii::make_array_view(patches[i]), patch_values(per_rank * rank + i).data());
      matrix.compress();
    }

    dealii::FullMatrix<double> dense() const
    {
      dealii::FullMatrix<double> matrix(3 * n_nodes);
      for (unsigned int i = 0; i < n_nodes; ++i)
        for (unsigned int r = 0; r < 9; ++r)
          for (unsigned int s = 0; s < 9; ++s)
            matrix(3 * patch(i)[r % 3] + r / 3, 3 * patch(i)[s % 3] + s / 3) +=
              patch_values(i)[9 * r + s];
      return matrix;
    }

    /// Compares the owned rows, entry by entry and as a product.
    void expect_equal(const BlockMatrix &matrix, const dealii::FullMatrix<double> &expected) const
    {
      dealii::FullMatrix<double> rows(3 * n_nodes);
      const unsigned int first = 3 * per_rank * rank;
      for (unsigned int i = 0; i < per_rank; ++i)
      {
        const std::size_t begin = matrix.row_start()[i], end = matrix.row_start()[i + 1];
        for (std::size_t k = begin; k < end; ++k)
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int b = 0; b < 3; ++b)
              rows(first + 3 * i + a, 3 * matrix.columns()[k] + b) =
                matrix.values()[9 * begin + (a * (end - begin) + k - begin) * 3 + b];
      }
      Vector x(unknowns), y(unknowns);
      dealii::Vector<double> dense_x(3 * n_nodes), dense_y(3 * n_nodes);
      for (unsigned int i = 0; i < 3 * n_nodes; ++i)
        dense_x(i) = std::sin(1. + i);
      for (unsigned int i = first; i < first + 3 * per_rank; ++i)
        x(i) = dense_x(i);
      matrix.vmult(y, x);
      expected.vmult(dense_y, dense_x);
      for (unsigned int i = first; i < first + 3 * per_rank; ++i)
      {
        EXPECT_NEAR(y(i), dense_y(i), 1e-12) << "unknown " << i;
        for (unsigned int j = 0; j < 3 * n_nodes; ++j)
          EXPECT_NEAR(rows(i, j), expected(i, j), 1e-13) << i << ' ' << j;
      }
    }
  };

  TEST(BlockMatrix, sums_the_patches_of_all_ranks)
  {
    const Ring ring;
    ring.expect_equal(ring.assembled(), ring.dense());
  }

  TEST(BlockMatrix, can_be_assembled_again)
  {
    const Ring ring;
    BlockMatrix matrix = ring.assembled();
    matrix.set_zero();
    ring.assemble(matrix);
    ring.expect_equal(matrix, ring.dense());
  }

  TEST(BlockMatrix, constrains_rows_and_columns_that_other_ranks_see)
  {
    const Ring ring;
    BlockMatrix matrix = ring.assembled();
    auto expected      = ring.dense();

    // Unknowns 2 (of node 0) and 4 (of node 1), known to their owner only; and one of a ghost node,
    // if there is one, which its owner learns of.
    std::vector<unsigned int> constrained;
    if (ring.rank == 0)
      constrained = {2, 4};
    std::vector<unsigned int> all = {2, 4};
    if (ring.n_nodes > Ring::per_rank)
    {
      all.push_back(3 * Ring::per_rank + 1); // of the first node of rank 1, a ghost of rank 0
      if (ring.rank == 0)
        constrained.push_back(ring.unknowns->global_to_local(all.back()));
    }
    matrix.constrain(constrained, 7.);
    for (const unsigned int i : all)
    {
      for (unsigned int j = 0; j < expected.m(); ++j)
        expected(i, j) = expected(j, i) = 0.;
      expected(i, i) = 7.;
    }
    ring.expect_equal(matrix, expected);
  }

  TEST(BlockMatrix, nodes_without_patches_have_a_diagonal_block)
  {
    const unsigned int n_nodes = 3;
    dealii::IndexSet owned     = dealii::complete_index_set(3 * n_nodes);
    const auto unknowns        = std::make_shared<const Partitioner>(owned, MPI_COMM_SELF);
    BlockMatrix matrix(unknowns, {});
    EXPECT_EQ(matrix.row_start(), (std::vector<std::size_t>{0, 1, 2, 3}));
    EXPECT_EQ(matrix.columns(), (std::vector<unsigned int>{0, 1, 2}));
    matrix.constrain({4}, 2.);
    EXPECT_DOUBLE_EQ(matrix.values()[9 + 4], 2.);
  }
} // namespace
