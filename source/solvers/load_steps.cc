// SPDX-License-Identifier: LGPL-2.1-or-later
// The loop over load steps.

#include <softcell/solvers/load_steps.h>

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <sstream>

namespace softcell
{
  void LoadStepParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Load steps", steps,
      "In how many equal steps the load is applied, or `adaptive`: the whole load at "
      "once, halved where that fails. A step that fails is halved in any case.");
    prm.add_parameter("Smallest load step", smallest,
                      "Part of the load below which a step is not halved any more: the run ends as "
                      "not converged, with what was reached. Units: 1",
                      dealii::Patterns::Double(0., 1.));
  }

  unsigned int LoadStepParameters::n_steps() const
  {
    if (steps == "adaptive")
      return 0;
    const bool is_number = !steps.empty() && steps.size() < 8 &&
                           steps.find_first_not_of("0123456789") == std::string::npos;
    const unsigned int number = is_number ? std::stoul(steps) : 0;
    if (number == 0)
      throw BadInput("Solver/Load steps = " + steps +
                     ": give a number from 1 to 9999999, or 'adaptive'.");
    return number;
  }

  LoadHistory follow_load(const NonlinearProblem &problem,
                          const NewtonParameters &newton,
                          const LoadStepParameters &parameters,
                          const std::function<void(double)> &set_load,
                          Vector &u,
                          const std::function<void(const LoadStep &)> &report_step,
                          const std::function<void(const NewtonIteration &)> &report_iteration,
                          const std::function<void(const LoadStep &, const Vector &)> &accepted,
                          const double start)
  {
    constexpr unsigned int easy = 6; // Newton iterations
    constexpr double round_off  = 1e-9;
    const unsigned int n_steps  = parameters.n_steps();
    const double largest_step   = n_steps > 0 ? 1. / n_steps : 1.;
    double step                 = largest_step;
    LoadHistory history;
    Vector solution(u);
    history.reached = start;
    for (LoadStep now{1, 0., 0., 1}; !history.converged;)
    {
      now.from = history.reached;
      now.to   = now.from + step < 1 - round_off ? now.from + step : 1.;
      set_load(now.to);
      if (report_step)
        report_step(now);

      const NewtonResult result = newton_raphson(problem, newton, u, report_iteration);
      history.newton_iterations += result.iterations;
      history.linear_iterations += result.linear_iterations;
      if (result.converged)
      {
        solution          = u;
        history.reached   = now.to;
        history.converged = now.to >= 1;
        ++history.load_steps;
        if (accepted)
          accepted(now, u);
        if (result.iterations <= easy)
          step = std::min(2 * step, largest_step);
        now = {now.number + 1, 0., 0., 1};
      }
      else
      {
        u    = solution;
        step = (now.to - now.from) / 2;
        ++now.attempt;
        if (step < std::max(parameters.smallest, round_off))
        {
          std::ostringstream reason;
          reason << "a step of " << now.to - now.from << " of the load from " << now.from
                 << " on fails: " << result.reason;
          history.reason = reason.str();
          break;
        }
      }
    }
    set_load(history.reached);
    return history;
  }
} // namespace softcell
