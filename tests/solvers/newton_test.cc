// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's method on equations whose solutions are known.

#include <softcell/solvers/newton.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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

  /// A chain of springs over all ranks, one node to a rank, of which the first and the last are
  /// imposed (component 0; the other components are springs to 0). Spring force: s + cubic * s^3
  /// for the stretch s > -1; beyond, inverted.
  struct Chain
  {
    // Every rank solves the same chain: what matters here is the imposed part, not the
    // distribution.
    static constexpr unsigned int n = 4;
    double cubic = 0, stretch = 1;
    std::shared_ptr<const Partitioner> unknowns =
      std::make_shared<const Partitioner>(dealii::complete_index_set(n), MPI_COMM_SELF);
    std::vector<double> k = std::vector<double>(n - 1);

    static bool imposed(const unsigned int i)
    {
      return i == 0 || i == n - 1;
    }

    NonlinearProblem problem()
    {
      NonlinearProblem p;
      p.residual = [this](const Vector &u, Vector &r) {
        r = 0.;
        for (unsigned int i = 0; i + 1 < n; ++i)
        {
          const double s = u(i + 1) - u(i), force = (1 + i) * (s + cubic * s * s * s);
          if (s > 2.)
            throw InvertedPoint("a spring is torn");
          r(i) -= force;
          r(i + 1) += force;
        }
        r(0) = r(n - 1) = 0.;
      };
      p.linearise = [this](const Vector &u) {
        for (unsigned int i = 0; i + 1 < n; ++i)
        {
          const double s = u(i + 1) - u(i);
          k[i]           = (1 + i) * (1 + 3 * cubic * s * s);
        }
      };
      // Two free unknowns, 1 and 2, by Cramer's rule.
      p.solve = [this](const Vector &r, const Vector &imposed_part, Vector &du) {
        du               = imposed_part;
        const double b_1 = -r(1) + k[0] * du(0), b_2 = -r(2) + k[2] * du(3);
        const double determinant = (k[0] + k[1]) * (k[1] + k[2]) - k[1] * k[1];
        du(1)                    = (b_1 * (k[1] + k[2]) + b_2 * k[1]) / determinant;
        du(2)                    = (b_2 * (k[0] + k[1]) + b_1 * k[1]) / determinant;
        return 1u;
      };
      p.missing_imposed = [this](const Vector &u, Vector &missing) {
        missing        = 0.;
        missing(0)     = -u(0);
        missing(n - 1) = stretch - u(n - 1);
      };
      p.force_scale = [this](const Vector &u) { return std::abs(u(n - 1) - u(n - 2)) * n; };
      return p;
    }
  };

  TEST(Newton, imposed_values_enter_a_linear_problem_in_one_iteration)
  {
    Chain chain;
    Vector u(chain.unknowns);
    const auto result = newton_raphson(chain.problem(), {}, u);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_EQ(result.iterations, 1u);
    // Compliances 1, 1/2 and 1/3 in series.
    EXPECT_NEAR(u(1), 6. / 11, 1e-14);
    EXPECT_NEAR(u(2), 9. / 11, 1e-14);
    EXPECT_DOUBLE_EQ(u(3), 1.);
  }

  TEST(Newton, a_shortened_step_enters_the_rest_later)
  {
    // The linear predictor stretches the first spring by 4 * 6/11 > 2; the stiffening spring ends
    // below 2.
    Chain chain;
    chain.cubic   = 2;
    chain.stretch = 4;
    Vector u(chain.unknowns);
    std::vector<double> steps;
    const auto result =
      newton_raphson(chain.problem(), {}, u, [&](const NewtonIteration &iteration) {
        steps.push_back(iteration.step);
        EXPECT_EQ(iteration.iteration, steps.size());
        EXPECT_EQ(iteration.linear_iterations, 1u);
      });
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_EQ(steps.front(), 0.5);
    EXPECT_EQ(steps.back(), 1.);
    EXPECT_NEAR(u(3), 4., 1e-12);
    const auto force = [&](const unsigned int i) {
      const double s = u(i + 1) - u(i);
      return (1 + i) * (s + 2 * s * s * s);
    };
    EXPECT_NEAR(force(0), force(1), 1e-6 * force(0));
    EXPECT_NEAR(force(1), force(2), 1e-6 * force(0));
  }
} // namespace
