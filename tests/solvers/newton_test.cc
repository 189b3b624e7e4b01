// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's method on equations whose solutions are known.

#include <softcell/solvers/newton.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{
  using namespace softcell;

  /// A single equation f(x) = 0 in the first of three unknowns; the others stay 0.
  struct ScalarEquation
  {
    std::function<double(double)> f, slope;
    double force_scale = 1;
    std::shared_ptr<const Partitioner> unknowns =
      std::make_shared<const Partitioner>(dealii::complete_index_set(3), MPI_COMM_SELF);
    std::vector<double> iterates = {}; // where it was linearised

    NonlinearProblem problem()
    {
      NonlinearProblem p;
      p.residual = [this](const Vector &u, Vector &r) {
        r    = 0.;
        r(0) = f(u(0));
      };
      p.linearise = [this](const Vector &u) { iterates.push_back(u(0)); };
      p.solve     = [this](const Vector &r, const Vector &, Vector &du) {
        du    = 0.;
        du(0) = -r(0) / slope(iterates.back());
        return 1u;
      };
      p.force_scale = [this](const Vector &) { return force_scale; };
      return p;
    }

    NewtonResult solve(double &x, const NewtonParameters &parameters = {})
    {
      Vector u(unknowns);
      u(0)              = x;
      const auto result = newton_raphson(problem(), parameters, u);
      x                 = u(0);
      return result;
    }
  };

  TEST(Newton, converges_quadratically)
  {
    ScalarEquation equation{[](double x) { return x * x - 2; }, [](double x) { return 2 * x; }};
    double x          = 1;
    const auto result = equation.solve(x, {1e-15, 0., 30, 12});
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_NEAR(x, std::sqrt(2.), 1e-15);
    EXPECT_EQ(result.linear_iterations, result.iterations);

    // e_k+1 = e_k^2 / (2 x_k) for this equation.
    for (unsigned int k = 0; k + 1 < equation.iterates.size(); ++k)
    {
      const double error = equation.iterates[k] - std::sqrt(2.);
      EXPECT_NEAR(equation.iterates[k + 1] - std::sqrt(2.),
                  error * error / (2 * equation.iterates[k]), 1e-15);
    }
  }

  // The first step goes from 0.3 to 3.9, where x^3 - 1 is 60 times as large.
  TEST(Newton, looks_at_the_search_residual_along_the_line)
  {
    for (const bool has_search_residual : {false, true})
    {
      ScalarEquation equation{[](double x) { return x * x * x - 1; },
                              [](double x) { return 3 * x * x; }};
      NonlinearProblem problem = equation.problem();
      if (has_search_residual)
        problem.search_residual = [](const Vector &, Vector &r) { r = 0.; };
      Vector u(equation.unknowns);
      u(0) = 0.3;
      EXPECT_TRUE(newton_raphson(problem, {}, u).converged);
      EXPECT_NEAR(u(0), 1, 1e-10);
      const double full = 0.3 + (1 - 0.027) / 0.27;
      if (has_search_residual)
        EXPECT_NEAR(equation.iterates[1], full, 1e-12);
      else
        EXPECT_LT(equation.iterates[1], full / 2 + 0.2);
    }
  }

  TEST(Newton, takes_no_iteration_where_nothing_is_to_do)
  {
    ScalarEquation equation{[](double x) { return x; }, [](double) { return 1.; }, 0.};
    double x          = 0;
    const auto result = equation.solve(x);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, 0u);
  }

  TEST(Newton, line_search_tames_an_overshoot)
  {
    // The plain iteration diverges from |x| > 1.39.
    ScalarEquation equation{[](double x) { return std::atan(x); },
                            [](double x) { return 1 / (1 + x * x); }};
    double x          = 3;
    const auto result = equation.solve(x);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_NEAR(x, 0., 1e-8);
  }

  TEST(Newton, keeps_clear_of_inverted_points_and_of_nan)
  {
    // log(x) = 0 from x = 5: the full step leads to 5 - 5 log 5 < 0.
    for (const bool throws : {true, false})
    {
      ScalarEquation equation{[=](double x) -> double {
                                if (x <= 0 && throws)
                                  throw InvertedPoint("x <= 0");
                                return std::log(x);
                              },
                              [](double x) { return 1 / x; }};
      double x          = 5;
      const auto result = equation.solve(x);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_NEAR(x, 1., 1e-7);
    }
  }

  TEST(Newton, ends_early_where_there_is_no_solution)
  {
    ScalarEquation equation{[](double x) { return x * x + 1; }, [](double x) { return 2 * x; }};
    double x          = 0.5;
    const auto result = equation.solve(x, {1e-8, 1e-8, 1000, 12});
    EXPECT_FALSE(result.converged);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_LT(result.iterations, 100u);
    EXPECT_TRUE(std::isfinite(x));
  }

  TEST(Newton, says_that_it_starts_inverted)
  {
    ScalarEquation equation{[](double) -> double { throw InvertedPoint("always"); }, {}};
    double x          = 1;
    const auto result = equation.solve(x);
    EXPECT_FALSE(result.converged);
    EXPECT_NE(result.reason.find("inverted"), std::string::npos);
  }

  TEST(Newton, passes_on_why_the_linear_solver_failed)
  {
    ScalarEquation equation{[](double x) { return x - 1; },
                            [](double) -> double { throw NotConverged("no luck"); }};
    double x          = 0;
    const auto result = equation.solve(x);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.reason, "no luck");
  }

  TEST(Newton, ends_where_rounding_hides_the_rest)
  {
    // The residual has a rounding error of 1e-7 of the force, as on a badly graded mesh, and
    // neither tolerance can be met: the update criterion is switched off.
    ScalarEquation equation{[](double x) { return 1e9 * (x - 1.) + 1e-4 * std::cos(1e12 * x); },
                            [](double) { return 1e9; }, 1e3};
    double x          = 0;
    const auto result = equation.solve(x, {1e-12, 0., 30, 12});
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_NEAR(x, 1., 1e-12);
  }

  TEST(Newton, a_wrong_tangent_reaches_the_tolerance_too)
  {
    // The error shrinks by 1 - 1/tangent an iteration. Already at 3e-8, the root of the machine
    // precision, rounding hides the energy still to gain. A tangent below 1/2 overshoots so far
    // that a full step enlarges the error.
    for (const double tangent : {1.2, 5., 0.8, 0.45})
    {
      ScalarEquation equation{[](double x) { return x - 1; }, [=](double) { return tangent; }};
      double x          = 0;
      const auto result = equation.solve(x, {1e-14, 0., 200, 12});
      EXPECT_TRUE(result.converged) << "tangent " << tangent << ": " << result.reason;
      EXPECT_NEAR(x, 1., 1e-14) << "tangent " << tangent;
    }
  }
} // namespace
