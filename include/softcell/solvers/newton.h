// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton-Raphson with a line search, for anything that offers a residual and a linearisation.
#pragma once

#include <softcell/base/types.h>

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <limits>

namespace softcell
{
  /// A nonlinear system r(u) = 0 in unknowns of which some are imposed. Every function is collective.
  struct NonlinearProblem
  {
    /// r(u) with ghost values of u up to date; 0 in imposed unknowns. Throws InvertedPoint on all ranks or none.
    std::function<void(const Vector &u, Vector &r)> residual;

    /// Assembles the tangent K = dr/du at u, ready for solve().
    std::function<void(const Vector &u)> linearise;

    /// Solves K du = -r where du equals `imposed` in the imposed unknowns (the predictor: the imposed increment
    /// enters through the tangent). Returns the linear iterations. `imposed` is 0 elsewhere.
    std::function<unsigned int(const Vector &r, const Vector &imposed, Vector &du)> solve;

    /// What is still missing in the imposed unknowns: target - u there, 0 elsewhere. May be empty: none imposed.
    std::function<void(const Vector &u, Vector &missing)> missing_imposed;

    /// Norm by which a residual is judged small, e.g. that of the applied forces and reactions at u.
    std::function<double(const Vector &u)> force_scale;
  };

  struct NewtonParameters
  {
    double       residual_tolerance = 1e-8; // relative to force_scale
    double       update_tolerance   = 1e-8; // |du| / |u|
    unsigned int max_iterations     = 30;
    unsigned int max_halvings       = 12; // of a step in the line search

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What an iteration looked like, for progress and for the record.
  struct NewtonIteration
  {
    unsigned int iteration         = 0;
    double       residual          = 0; // relative
    double       update            = 0; // relative
    double       step              = 1; // what the line search left of the full step
    unsigned int linear_iterations = 0;
  };

  struct NewtonResult
  {
    bool         converged         = false;
    unsigned int iterations        = 0;
    unsigned int linear_iterations = 0;
    std::string  reason; // why not converged, one clause
  };

  /// Solves r(u) = 0 from u, which is changed to the best that was reached.
  /// Converged by either criterion of Brunet, algorithm 1 (residual, update), with nothing of the imposed values
  /// missing. The line search halves a step until no point is inverted and the residual allows it.
  NewtonResult newton_raphson(const NonlinearProblem                             &problem,
                              const NewtonParameters                             &parameters,
                              Vector                                             &u,
                              const std::function<void(const NewtonIteration &)> &report = {});
} // namespace softcell
