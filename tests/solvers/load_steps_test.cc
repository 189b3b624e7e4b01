// SPDX-License-Identifier: LGPL-2.1-or-later
// Load steps on an equation whose solution is known and whose reach in one step is limited.

#include <softcell/solvers/load_steps.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{
  using namespace softcell;

  /// x = t * target. A step longer than `reach` is refused as if a point were inverted, whatever
  /// its length.
  struct Reach
  {
    double target = 1, reach = 1, barrier = 2;
    double t = 0, x = 0; // load factor and where the last accepted step ended
    std::vector<LoadStep> attempts, accepted;
    std::shared_ptr<const Partitioner> unknowns =
      std::make_shared<const Partitioner>(dealii::complete_index_set(3), MPI_COMM_SELF);

    NonlinearProblem problem()
    {
      NonlinearProblem p;
      p.residual = [this](const Vector &u, Vector &r) {
        if (std::abs(t * target - x) > reach || u(0) > barrier)
          throw InvertedPoint("too far");
        r    = 0.;
        r(0) = u(0) - t * target;
      };
      p.linearise = [](const Vector &) {};
      p.solve     = [](const Vector &r, const Vector &, Vector &du) {
        du = r;
        du *= -1;
        return 3u;
      };
      p.force_scale = [](const Vector &) { return 1.; };
      return p;
    }

    LoadHistory follow(const LoadStepParameters &parameters, double &end, const double start = 0)
    {
      Vector u(unknowns);
      u(0) = x           = start * target;
      const auto history = follow_load(
        problem(), {}, parameters, [this](const double factor) { t = factor; }, u,
        [this](const LoadStep &step) { attempts.push_back(step); }, {},
        [this](const LoadStep &step, const Vector &solution) {
          accepted.push_back(step);
          x = solution(0);
        },
        start);
      end = u(0);
      return history;
    }
  };

  TEST(LoadSteps, a_number_is_taken_literally_where_nothing_fails)
  {
    Reach equation;
    double end;
    const auto history = equation.follow({"4", 1e-4}, end);
    EXPECT_TRUE(history.converged);
    EXPECT_EQ(history.load_steps, 4u);
    EXPECT_EQ(history.newton_iterations, 4u);
    EXPECT_EQ(history.linear_iterations, 12u);
    EXPECT_NEAR(end, 1., 1e-14);
    for (unsigned int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(equation.accepted[i].number, i + 1);
      EXPECT_DOUBLE_EQ(equation.accepted[i].to, 0.25 * (i + 1));
    }
  }

  TEST(LoadSteps, an_adaptive_run_cuts_back_and_grows)
  {
    Reach equation;
    double end;
    equation.reach     = 0.3;
    const auto history = equation.follow({"adaptive", 1e-4}, end);
    EXPECT_TRUE(history.converged);
    EXPECT_NEAR(end, 1., 1e-14);
    // 1 and 1/2 fail, 1/4 works; 1/2 is tried again after it, and so on.
    ASSERT_GE(equation.attempts.size(), 5u);
    EXPECT_DOUBLE_EQ(equation.attempts[0].to, 1.);
    EXPECT_DOUBLE_EQ(equation.attempts[1].to, 0.5);
    EXPECT_DOUBLE_EQ(equation.attempts[2].to, 0.25);
    EXPECT_EQ(equation.attempts[2].attempt, 3u);
    EXPECT_EQ(equation.attempts[2].number, 1u);
    EXPECT_DOUBLE_EQ(equation.attempts[3].to, 0.75);
    EXPECT_EQ(equation.attempts[3].attempt, 1u);
    EXPECT_EQ(history.load_steps, 4u);
    EXPECT_EQ(equation.accepted.back().to, 1.);
  }

  TEST(LoadSteps, a_number_of_steps_is_cut_back_too_but_never_exceeded)
  {
    Reach equation;
    double end;
    equation.reach     = 0.3;
    const auto history = equation.follow({"2", 1e-4}, end);
    EXPECT_TRUE(history.converged);
    for (const LoadStep &step : equation.attempts)
      EXPECT_LE(step.to - step.from, 0.5 + 1e-15);
    EXPECT_EQ(history.load_steps, 4u);
  }

  TEST(LoadSteps, gives_up_at_the_smallest_step_with_what_was_reached)
  {
    Reach equation;
    double end;
    equation.barrier   = 0.6;
    const auto history = equation.follow({"adaptive", 1e-3}, end);
    EXPECT_FALSE(history.converged);
    EXPECT_FALSE(history.reason.empty());
    EXPECT_LE(history.reached, 0.6);
    EXPECT_GT(history.reached, 0.6 - 2e-3);
    EXPECT_NEAR(end, history.reached, 1e-12);
    EXPECT_DOUBLE_EQ(equation.t, history.reached);
  }

  TEST(LoadSteps, goes_on_from_where_a_run_stopped)
  {
    Reach equation;
    double end;
    const auto history = equation.follow({"4", 1e-4}, end, 0.5);
    EXPECT_TRUE(history.converged);
    ASSERT_EQ(equation.accepted.size(), 2u);
    EXPECT_DOUBLE_EQ(equation.accepted[0].from, 0.5);
    EXPECT_DOUBLE_EQ(equation.accepted[0].to, 0.75);
    EXPECT_NEAR(end, 1., 1e-14);
  }

  TEST(LoadSteps, solves_for_the_whole_load_once_more)
  {
    Reach equation;
    double end;
    EXPECT_TRUE(equation.follow({"4", 1e-4}, end, 1).converged);
    ASSERT_EQ(equation.accepted.size(), 1u);
    EXPECT_EQ(equation.accepted[0].to, 1.);

    equation.barrier   = 0.5;
    const auto history = equation.follow({"4", 0}, end, 1);
    EXPECT_FALSE(history.converged);
    EXPECT_EQ(history.reached, 1.);
  }

  TEST(LoadSteps, refuses_what_is_not_a_number)
  {
    for (const std::string steps : {"", "0", "-3", "2.5", "many", "99999999999999"})
      EXPECT_THROW((LoadStepParameters{steps, 1e-4}.n_steps()), BadInput) << steps;
    EXPECT_EQ((LoadStepParameters{"12", 1e-4}.n_steps()), 12u);
    EXPECT_EQ((LoadStepParameters{"adaptive", 1e-4}.n_steps()), 0u);
  }

  TEST(LoadSteps, parameters_are_read_from_the_section_that_is_open)
  {
    LoadStepParameters load;
    NewtonParameters newton;
    dealii::ParameterHandler prm;
    prm.enter_subsection("Solver");
    load.add_parameters(prm);
    newton.add_parameters(prm);
    prm.leave_subsection();
    prm.parse_input_from_string(
      "subsection Solver\nset Load steps = adaptive\nset Newton iterations = 7\nend\n");
    EXPECT_EQ(load.n_steps(), 0u);
    EXPECT_EQ(newton.max_iterations, 7u);
  }
} // namespace
