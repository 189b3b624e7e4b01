// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's iteration and its line search.

#include <softcell/solvers/newton.h>

#include <softcell/base/exceptions.h>
#include <softcell/solvers/dot.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace softcell
{
  namespace
  {
    // Newton gives up after this many steps in a row each of which the line search made shorter
    // than `short_step`, or which leave the residual above `progress` times the smallest so far;
    // after one, where rounding hides what is left to gain.
    constexpr unsigned int max_poor_steps = 8;
    constexpr double short_step           = 1. / 8;
    constexpr double progress             = 0.9;

    /// One run of newton_raphson(): the point reached, with its residual, and the step to the next.
    class Newton
    {
    public:
      Newton(const NonlinearProblem &problem, const NewtonParameters &parameters, Vector &u)
          : problem_(problem),
            parameters_(parameters),
            u_(u),
            r_(u),
            missing_(u),
            du_(u),
            trial_u_(u),
            trial_r_(u)
      {
        for (Vector *const vector : {&r_, &missing_, &du_, &trial_r_})
        {
          vector->zero_out_ghost_values();
          *vector = 0.;
        }
      }

      NewtonResult run(const std::function<void(const NewtonIteration &)> &report);

    private:
      enum class Step
      {
        accepted,
        last, // accepted, and nothing is left to gain
        rejected
      };

      void look_what_is_missing();
      bool has_converged() const;
      bool is_poor(Step step, const NewtonIteration &iteration);
      bool evaluate_trial(double step,
                          const std::function<void(const Vector &, Vector &)> &residual);
      Step search_line(NewtonIteration &iteration);

      const NonlinearProblem &problem_;
      const NewtonParameters &parameters_;

      Vector &u_;
      Vector r_, missing_, du_, trial_u_, trial_r_;
      double scale_             = 0;     // of forces, at u
      bool entering_            = false; // part of the imposed values is still missing
      bool stalled_             = false; // what the last step could gain is lost in rounding
      double smallest_residual_ = std::numeric_limits<double>::max();
    };

    void Newton::look_what_is_missing()
    {
      scale_    = problem_.force_scale(u_);
      entering_ = false;
      if (problem_.missing_imposed)
      {
        problem_.missing_imposed(u_, missing_);
        constexpr double round_off = 1e-12;
        entering_                  = missing_.l2_norm() > round_off * u_.l2_norm();
      }
    }

    /// A residual at u + step du; false if a point is inverted there or the residual is not finite.
    bool Newton::evaluate_trial(const double step,
                                const std::function<void(const Vector &, Vector &)> &residual)
    {
      trial_u_.zero_out_ghost_values();
      std::copy_n(u_.begin(), u_.locally_owned_size(), trial_u_.begin());
      trial_u_.add(step, du_);
      trial_u_.update_ghost_values();
      try
      {
        residual(trial_u_, trial_r_);
      }
      catch (const InvertedPoint &)
      {
        return false;
      }
      return std::isfinite(dot(trial_r_, trial_r_));
    }

    /// Halves the step until nothing is inverted and the step gains something: the residual gets
    /// smaller, or the energy, whose slope along the step is du . r, goes down.
    Newton::Step Newton::search_line(NewtonIteration &iteration)
    {
      stalled_ = false;
      if (!std::isfinite(dot(du_, du_)))
        return Step::rejected;
      const double residual = r_.l2_norm(), slope = du_ * r_;
      const double length = du_.l2_norm(), u_norm = u_.l2_norm();

      // The energy that the step could gain is lost in the rounding of the work done so far. Being
      // quadratic in the residual, it is so long before the residual is as small as it can get.
      stalled_ = !entering_ && std::abs(slope) <= 1e-15 * scale_ * u_norm;

      for (unsigned int halving = 0; halving <= parameters_.max_halvings; ++halving)
      {
        iteration.step = std::ldexp(1., -int(halving));
        if (!evaluate_trial(iteration.step, problem_.search_residual ? problem_.search_residual
                                                                     : problem_.residual))
          continue;
        const double trial_slope  = du_ * trial_r_;
        const double trial_length = trial_u_.l2_norm();
        iteration.update          = trial_length > 0 ? iteration.step * length / trial_length : 0.;
        const bool full           = halving == 0;
        const bool small          = full && iteration.update <= parameters_.update_tolerance;
        const bool smaller_residual = trial_r_.l2_norm() <= (1 - 1e-4 * iteration.step) * residual;
        const bool lower_energy =
          !stalled_ && slope < 0 && trial_slope <= -0.8 * slope && trial_slope >= 2 * slope;
        if (!entering_ && full && small)
          return Step::last;
        // While imposed values enter, the residual may rise: the step is judged by the next one.
        if (entering_ || smaller_residual || lower_energy)
          return Step::accepted;
      }
      return Step::rejected;
    }

    bool Newton::has_converged() const
    {
      return !entering_ && r_.l2_norm() <= parameters_.residual_tolerance * scale_;
    }

    /// Whether the step that led to u, or was to lead on from it, gained little.
    bool Newton::is_poor(const Step step, const NewtonIteration &iteration)
    {
      const double residual = r_.l2_norm();
      const bool poor       = step == Step::rejected || iteration.step < short_step ||
                        (!entering_ && residual > progress * smallest_residual_);
      // A residual from before all imposed values were in is no measure.
      if (!entering_)
        smallest_residual_ = std::min(residual, smallest_residual_);
      return poor;
    }

    NewtonResult Newton::run(const std::function<void(const NewtonIteration &)> &report)
    {
      NewtonResult result;
      u_.update_ghost_values();
      if (!evaluate_trial(0., problem_.residual))
      {
        result.reason = std::isfinite(dot(trial_r_, trial_r_)) // still 0
                          ? "a point is inverted before the first iteration"
                          : "a force is not a finite number before the first iteration";
        return result;
      }
      r_.swap(trial_r_);
      look_what_is_missing();
      result.converged = has_converged();

      for (unsigned int poor_steps = 0; !result.converged && result.reason.empty();)
      {
        NewtonIteration iteration;
        iteration.iteration = ++result.iterations;
        try
        {
          problem_.linearise(u_);
          iteration.linear_iterations = problem_.solve(r_, missing_, du_);
        }
        catch (const NotConverged &failure)
        {
          result.reason = failure.what();
          break;
        }
        result.linear_iterations += iteration.linear_iterations;

        const Step step = search_line(iteration);
        if (step != Step::rejected)
        {
          u_.swap(trial_u_);
          if (problem_.search_residual)
            problem_.residual(u_, r_);
          else
            r_.swap(trial_r_);
          look_what_is_missing();
        }
        iteration.residual = scale_ > 0 ? r_.l2_norm() / scale_ : r_.l2_norm();
        if (report)
          report(iteration);

        poor_steps       = is_poor(step, iteration) ? poor_steps + 1 : 0;
        result.converged = step == Step::last || (step == Step::accepted && has_converged()) ||
                           (stalled_ && poor_steps > 0);
        if (result.converged)
          break;
        if (step == Step::rejected)
          result.reason = "no step along Newton's direction gains anything";
        else if (poor_steps == max_poor_steps)
          result.reason = std::to_string(poor_steps) + " Newton steps in a row gained little";
        else if (result.iterations == parameters_.max_iterations)
          result.reason = "'Solver/Newton iterations' = " + std::to_string(result.iterations) +
                          " were not enough";
      }
      return result;
    }
  } // namespace

  void NewtonParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Residual tolerance", residual_tolerance,
                      "A step has converged when the residual is this small relative to the forces "
                      "that act on the body, supports included; or where it falls no further "
                      "because rounding hides the energy that is left to gain, as it may on badly "
                      "graded meshes. Units: 1",
                      dealii::Patterns::Double(0., 0.1));
    prm.add_parameter("Update tolerance", update_tolerance,
                      "A step has also converged when a full Newton step changes the displacement "
                      "by no more than this, relatively, whatever the residual; 0 asks for the "
                      "residual alone. Units: 1",
                      dealii::Patterns::Double(0., 0.1));
    prm.add_parameter("Newton iterations", max_iterations,
                      "Iterations after which a load step has failed.",
                      dealii::Patterns::Integer(1));
    prm.add_parameter("Line search halvings", max_halvings,
                      "How often the line search may halve a Newton step before the load step has "
                      "failed.",
                      dealii::Patterns::Integer(0, 50));
  }

  NewtonResult newton_raphson(const NonlinearProblem &problem,
                              const NewtonParameters &parameters,
                              Vector &u,
                              const std::function<void(const NewtonIteration &)> &report)
  {
    return Newton(problem, parameters, u).run(report);
  }
} // namespace softcell
