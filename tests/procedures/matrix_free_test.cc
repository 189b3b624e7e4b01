// SPDX-License-Identifier: LGPL-2.1-or-later
// Geometric multigrid without a matrix against a direct solver.

#include "small_problems.h"

namespace
{
  using namespace softcell;

  void expect_the_same(Parameters parameters)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      GTEST_SKIP() << "one rank alone";
    const Solved assembled                  = solve(parameters);
    parameters.linear_solver.solver         = "CG";
    parameters.linear_solver.preconditioner = "geometric multigrid";
    parameters.linear_solver.tolerance      = 1e-10;
    const Solved matrix_free                = solve(parameters);
    Vector difference                       = matrix_free.simulation->displacement();
    difference -= assembled.simulation->displacement();
    // what the tolerance of Newton's method leaves, times the condition of the body
    EXPECT_LT(difference.linfty_norm(), 1e-8 * assembled.simulation->displacement().linfty_norm());
    EXPECT_NEAR(matrix_free.row.number("newton_iterations"),
                assembled.row.number("newton_iterations"), 1);
  }

  TEST(MatrixFree, BendsAHeldCylinderAsTheMatrixDoes)
  {
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
    {
      SCOPED_TRACE(model);
      Parameters p      = body_of("cylinder", {"weighted cell", 1}, 5);
      p.geometry.length = 3;
      p.material.model  = model;
      p.regions         = {{"base", "z < 1e-6"}, {"top", "z > 3 - 1e-6"}};
      p.load_entries    = {{"base", "clamp"}, {"top", "traction 0, -3, 0"}};
      expect_the_same(p);
    }
  }

  // The supports' tangents are the matrix, on every grid.
  TEST(MatrixFree, HoldsASphereByItsSurfaceAsTheMatrixDoes)
  {
#ifndef NDEBUG
    GTEST_SKIP() << "takes minutes without optimisation";
#endif
    using Names = std::vector<std::pair<std::string, std::string>>;
    for (const auto &[imposition, method] :
         Names{{"penalty", "weighted cell"}, {"Nitsche", "moment fitting"}})
    {
      SCOPED_TRACE(imposition + ' ' + method);
      Parameters p       = body_of("sphere", {method.c_str(), 1}, 7);
      p.regions          = {{"base", "z < 0.3"}, {"top", "z > 0.8"}};
      p.load_entries     = {{"base", "clamp"}, {"top", "displacement 0.05, 0, 0.1"}};
      p.loads.imposition = imposition;
      expect_the_same(p);
    }
  }

  // Euler's strain for a column clamped at both ends, pi^2 (r / l)^2 = 0.07, is passed by far: the
  // tangent of the straight column is indefinite then. Bent aside it has less energy than straight.
  TEST(MatrixFree, FollowsAColumnBeyondBuckling)
  {
#ifndef NDEBUG
    GTEST_SKIP() << "takes minutes without optimisation";
#endif
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      GTEST_SKIP() << "one rank alone";
    Parameters p           = body_of("cylinder", {"weighted cell", 1}, 4);
    p.geometry.length      = 6;
    p.material.density     = 1;
    p.loads.gravity        = Direction({0.1, 0, 0}); // tells to which side
    p.regions              = {{"base", "z < 1e-6"}, {"top", "z > 6 - 1e-6"}};
    p.load_entries         = {{"base", "clamp"}, {"top", "displacement 0, 0, -1.2"}};
    p.load_steps.steps     = "adaptive";
    p.linear_solver.solver = "CG"; // a direct one finds equilibria that are not stable
    const auto energy      = [&p](const char *preconditioner) {
      p.linear_solver.preconditioner = preconditioner;
      return solve(p).row.number("strain_energy");
    };
    const double bent     = energy("geometric multigrid");
    const double straight = 0.5 * p.material.young_modulus * 0.04 * M_PI * 0.25 * 6;
    EXPECT_LT(bent, 0.75 * straight);
    EXPECT_NEAR(bent, energy("Jacobi"), 1e-9 * bent);
  }
} // namespace
