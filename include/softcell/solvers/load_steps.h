// SPDX-License-Identifier: LGPL-2.1-or-later
// Following a load from 0 to 1 in steps that grow and cut back.
#pragma once

#include <softcell/solvers/newton.h>

#include <functional>
#include <string>

namespace softcell
{
  struct LoadStepParameters
  {
    std::string  steps        = "1"; // a number, or `adaptive`
    double       smallest     = 1e-4; // load factor increment below which an adaptive run gives up

    void add_parameters(dealii::ParameterHandler &prm);
  };

  struct LoadStep
  {
    unsigned int number = 0; // from 1
    double       from = 0, to = 0; // load factor
    unsigned int attempt = 1;
  };

  struct LoadHistory
  {
    bool         converged         = false;
    double       reached           = 0; // load factor
    unsigned int load_steps        = 0; // converged ones
    unsigned int newton_iterations = 0;
    unsigned int linear_iterations = 0;
    std::string  reason; // why it stopped short
  };

  /// Solves r(u; t) = 0 at load factors t from 0 to 1, each from the solution before.
  ///
  /// With a number n of steps, a step that fails is halved too, and the run goes on with the smaller step; adaptive
  /// runs start with the whole load, halve on failure and double after an easy step.
  /// @param set_load called with the load factor before each attempt.
  /// @param accepted called after each converged step.
  LoadHistory follow_load(const NonlinearProblem                             &problem,
                          const NewtonParameters                             &newton,
                          const LoadStepParameters                           &parameters,
                          const std::function<void(double)>                  &set_load,
                          Vector                                             &u,
                          const std::function<void(const LoadStep &)>        &report_step = {},
                          const std::function<void(const NewtonIteration &)> &report_iteration = {},
                          const std::function<void(const LoadStep &, const Vector &)> &accepted = {});
} // namespace softcell
