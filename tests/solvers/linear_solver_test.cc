// SPDX-License-Identifier: LGPL-2.1-or-later
// Every solver on a lattice of springs, on any number of ranks.

#include "spring_lattice.h"

#include <softcell/base/exceptions.h>
#include <softcell/solvers/approximate_inverse.h>
#include <softcell/solvers/linear_solver.h>

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

namespace
{
  using namespace softcell;

  LinearSolverParameters parameters(const std::string &solver,
                                    const std::string &preconditioner,
                                    const std::string &backend)
  {
    LinearSolverParameters result;
    result.solver         = solver;
    result.preconditioner = preconditioner;
    result.backend        = backend;
    result.tolerance      = 1e-10;
    return result;
  }

  class LinearSolverOn
      : public testing::TestWithParam<std::tuple<std::string, std::string, std::string>>
  {
  protected:
    static std::unique_ptr<LinearSolver> make_solver(const bool is_symmetric)
    {
      return std::apply(
        [&](auto... names) { return make_linear_solver(parameters(names...), is_symmetric); },
        GetParam());
    }

    std::unique_ptr<LinearSolver> solver = make_solver(true);
  };

  TEST_P(LinearSolverOn, solves_the_lattice_again_and_again)
  {
    SpringLattice lattice(5);
    solver->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
    lattice.expect_solution(*solver, 1e-10);

    // Other values in the same structure; -0.3 adds to the diagonal.
    lattice.assemble(-0.3);
    solver->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
    lattice.expect_solution(*solver, 1e-10);
  }

  TEST_P(LinearSolverOn, solves_an_unsymmetric_lattice)
  {
    SpringLattice lattice(5);
    const auto general = make_solver(false);
    for (const double twist : {0.1, -0.2})
    {
      lattice.assemble(0, twist);
      general->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
      lattice.expect_solution(*general, 1e-10);
    }
  }

  TEST_P(LinearSolverOn, never_returns_what_is_not_finite)
  {
    const SpringLattice lattice(3);
    Vector b(lattice.unknowns), x(lattice.unknowns);
    b = 1.;
    if (b.locally_owned_size() > 0)
      b.local_element(0) = std::numeric_limits<double>::quiet_NaN();
    for (const bool is_symmetric : {true, false})
    {
      solver = make_solver(is_symmetric);
      solver->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
      EXPECT_THROW(solver->solve(x, b), NotConverged);
    }
  }

  TEST_P(LinearSolverOn, goes_down_the_energy_of_an_indefinite_matrix)
  {
    const SpringLattice lattice(4, 0.2);
    Vector b(lattice.unknowns), x(lattice.unknowns), Ax(lattice.unknowns);
    b = 1.;
    for (const unsigned int i : lattice.held)
      b.local_element(i) = 0.;
    solver->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
    try
    {
      solver->solve(x, b);
    }
    catch (const NotConverged &failure)
    {
      // What approximates an indefinite matrix may be indefinite itself.
      const std::string preconditioner = std::get<1>(GetParam());
      EXPECT_TRUE(preconditioner == "AMG" || preconditioner == "incomplete Cholesky");
      EXPECT_NE(std::string(failure.what()).find("not positive definite"), std::string::npos)
        << failure.what();
      return;
    }
    EXPECT_TRUE(std::isfinite(x.l2_norm()));
    if (std::get<0>(GetParam()) == "CG")
      EXPECT_GT(x * b, 0.);
    else
      lattice.expect_solution(*solver, 1e-8);
  }

  INSTANTIATE_TEST_SUITE_P(All,
                           LinearSolverOn,
                           testing::Values(std::tuple{"direct", "none", "Trilinos"},
                                           std::tuple{"CG", "none", "Trilinos"},
                                           std::tuple{"CG", "Jacobi", "Trilinos"},
                                           std::tuple{"CG", "incomplete Cholesky", "Trilinos"},
                                           std::tuple{"CG", "AMG", "Trilinos"},
                                           std::tuple{"direct", "none", "PETSc"},
                                           std::tuple{"CG", "none", "PETSc"},
                                           std::tuple{"CG", "Jacobi", "PETSc"},
                                           std::tuple{"CG", "incomplete Cholesky", "PETSc"},
                                           std::tuple{"CG", "AMG", "PETSc"}),
                           [](const auto &values) {
                             std::string name =
                               std::apply([](auto... names) { return (... + std::string(names)); },
                                          values.param);
                             name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                             return name;
                           });

  TEST(LinearSolver, multigrid_iterations_hardly_grow)
  {
    for (const std::string backend : {"Trilinos", "PETSc"})
    {
      const auto solver_small = make_linear_solver(parameters("CG", "AMG", backend));
      const auto solver_large = make_linear_solver(parameters("CG", "AMG", backend));
      const SpringLattice small(5), large(15);
      solver_small->set_matrix(*small.matrix, small.positions, small.held);
      solver_large->set_matrix(*large.matrix, large.positions, large.held);
      const unsigned int few  = small.expect_solution(*solver_small, 1e-10);
      const unsigned int many = large.expect_solution(*solver_large, 1e-10);
      EXPECT_LE(many, 2 * few) << backend;
      EXPECT_LE(many, 40u) << backend;
    }
  }

  TEST(LinearSolver, says_how_far_it_came)
  {
    const SpringLattice lattice(5);
    auto few           = parameters("CG", "Jacobi", "Trilinos");
    few.max_iterations = 3;
    for (const bool is_symmetric : {true, false})
    {
      const auto solver = make_linear_solver(few, is_symmetric);
      solver->set_matrix(*lattice.matrix, lattice.positions, lattice.held);
      Vector b(lattice.unknowns), x(lattice.unknowns);
      b = 1.;
      try
      {
        solver->solve(x, b);
        FAIL();
      }
      catch (const NotConverged &failure)
      {
        const std::string what = failure.what();
        EXPECT_EQ(what.find(is_symmetric ? "conjugate gradients" : "GMRES"), 0u);
        EXPECT_NE(what.find("Jacobi"), std::string::npos);
        EXPECT_NE(what.find("in 3 iterations"), std::string::npos);
      }
      EXPECT_EQ(solver->history().size(), 3u);
    }
  }

  TEST(LinearSolver, stops_at_once_at_negative_curvature)
  {
    // -I: the first direction has negative curvature.
    const auto unknowns =
      std::make_shared<const Partitioner>(dealii::complete_index_set(3), MPI_COMM_SELF);
    BlockMatrix matrix(unknowns, {});
    matrix.constrain({0, 1, 2}, -1.);
    const auto solver = make_linear_solver(parameters("CG", "none", "Trilinos"));
    solver->set_matrix(matrix, {Point()}, {});
    Vector b(unknowns), x(unknowns);
    b = 2.;
    EXPECT_EQ(solver->solve(x, b), 1u);
    EXPECT_DOUBLE_EQ(x(1), 2.);
    EXPECT_TRUE(std::isnan(solver->condition()));
  }

  TEST(LinearSolver, rigid_body_modes_carry_no_spring_force)
  {
    SpringLattice lattice(4);
    lattice.held.clear();
    lattice.assemble(0.);
    const auto modes = rigid_body_modes(lattice.unknowns, lattice.positions, {});
    ASSERT_EQ(modes.size(), 6u);
    for (unsigned int m = 0; m < 6; ++m)
    {
      Vector force(lattice.unknowns);
      lattice.matrix->vmult(force, modes[m]);
      EXPECT_LE(force.l2_norm(), 1e-12);
      for (unsigned int k = 0; k < 6; ++k)
        EXPECT_NEAR(modes[m] * modes[k], m == k ? 1. : 0., 1e-12);
    }
  }
} // namespace
