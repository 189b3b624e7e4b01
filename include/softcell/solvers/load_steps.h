// SPDX-License-Identifier: LGPL-2.1-or-later
// Following a load to 1 in steps that grow and cut back.
#pragma once

#include <softcell/solvers/newton.h>

#include <functional>
#include <string>

namespace softcell
{
  struct LoadStepParameters
  {
    std::string steps = "1";  // a number, or `adaptive`
    double smallest   = 1e-4; // load factor increment below which a run gives up

    /// Declares the entries in the section that is open, `Solver`.
    void add_parameters(dealii::ParameterHandler &prm);

    /// The number that `steps` holds; 0 for `adaptive`. @throws BadInput
    unsigned int n_steps() const;
  };

  struct LoadStep
  {
    unsigned int number = 0; // from 1
    double from = 0, to = 0; // load factor
    unsigned int attempt = 1;
  };

  struct LoadHistory
  {
    bool converged                 = false;
    double reached                 = 0; // load factor
    unsigned int load_steps        = 0; // converged ones
    unsigned int newton_iterations = 0; // those of failed attempts included
    unsigned int linear_iterations = 0;
    std::string reason; // why it stopped short
  };

  /// Solves r(u; t) = 0 at load factors t from `start` to 1, each from the solution before.
  ///
  /// With a number n of steps, a step that fails is halved and the run goes on with the smaller
  /// step; adaptive runs start with the whole load. Both double the step after an easy one, up to
  /// 1/n or the whole load. A failed attempt gives back the solution before it. Steps start from
  /// that solution and not from an extrapolation: the tangent's first step is as good a predictor,
  /// and it keeps clear of inverted points.
  /// @param set_load called with the load factor before each attempt, and at the end with the one
  /// that was reached.
  /// @param u changed to the solution at the load factor reached.
  /// @param accepted called after each converged step.
  /// @param start load factor of u as it comes; from 1, the whole load is solved for once more.
  /// @throws BadInput if `steps` is neither a number from 1 on nor `adaptive`
  LoadHistory
  follow_load(const NonlinearProblem &problem,
              const NewtonParameters &newton,
              const LoadStepParameters &parameters,
              const std::function<void(double)> &set_load,
              Vector &u,
              const std::function<void(const LoadStep &)> &report_step              = {},
              const std::function<void(const NewtonIteration &)> &report_iteration  = {},
              const std::function<void(const LoadStep &, const Vector &)> &accepted = {},
              double start                                                          = 0);
} // namespace softcell
