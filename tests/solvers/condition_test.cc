// SPDX-License-Identifier: LGPL-2.1-or-later
// The condition number that conjugate gradients find, on a matrix of known spectrum.

#include <softcell/solvers/linear_solver.h>

#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    /// A chain of n nodes between two walls, whose springs act along all axes alike: its
    /// eigenvalues are 2 - 2 cos(k pi / (n + 1)).
    BlockMatrix chain(const unsigned int n)
    {
      std::vector<std::vector<unsigned int>> springs;
      for (unsigned int i = 1; i < n; ++i)
        springs.push_back({i - 1, i});
      BlockMatrix matrix(
        std::make_shared<const Partitioner>(dealii::complete_index_set(3 * n), MPI_COMM_SELF),
        springs);
      std::vector<double> pull(36, 0.), wall(9, 0.);
      for (unsigned int a = 0; a < 3; ++a)
      {
        wall[a * 4] = 1;
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int j = 0; j < 2; ++j)
            pull[(a * 2 + i) * 6 + a * 2 + j] = i == j ? 1 : -1;
      }
      for (const auto &nodes : springs)
        matrix.add(dealii::make_array_view(nodes), pull.data());
      for (const unsigned int end : {0u, n - 1})
        matrix.add(dealii::ArrayView<const unsigned int>(&end, 1), wall.data());
      matrix.compress();
      return matrix;
    }
  } // namespace

  TEST(Condition, conjugate_gradients_find_the_condition_number)
  {
    constexpr unsigned int n    = 40;
    const BlockMatrix matrix    = chain(n);
    const double half_a_step    = M_PI / (2 * (n + 1));
    const double condition      = 1 / std::pow(std::tan(half_a_step), 2);
    const auto condition_number = [&](const std::string &solver, const std::string &preconditioner,
                                      const bool is_symmetric = true) {
      const auto all = make_linear_solver({solver, preconditioner, "PETSc", 1e-10}, is_symmetric);
      all->set_matrix(matrix, std::vector<Point>(n), {});
      Vector b(matrix.partitioner()), x(b);
      for (unsigned int i = 0; i < 3 * n; ++i)
        b(i) = std::sin(1. + i * i);
      all->solve(x, b);
      return all->condition();
    };
    // A Ritz value errs by the square of what is left of its vector, which is less than 1e-6 here.
    EXPECT_NEAR(condition_number("CG", "none"), condition, 1e-9 * condition);
    EXPECT_NEAR(condition_number("CG", "Jacobi"), condition, 1e-9 * condition); // all diagonals 2
    EXPECT_NEAR(condition_number("CG", "incomplete Cholesky"), 1., 1e-9);       // no fill: exact
    EXPECT_TRUE(std::isnan(condition_number("direct", "none")));
    EXPECT_TRUE(std::isnan(condition_number("CG", "none", false)));
  }
} // namespace softcell
