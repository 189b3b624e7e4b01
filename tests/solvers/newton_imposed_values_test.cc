// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's method where some of the unknowns are imposed.

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
