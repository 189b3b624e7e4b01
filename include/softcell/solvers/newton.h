// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton-Raphson with a line search, for anything that offers a residual and a linearisation.
#pragma once

#include <softcell/base/types.h>

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <limits>

namespace softcell
{
  /// A nonlinear system r(u) = 0 in unknowns of which some are imposed. Every function is
  /// collective.
  struct NonlinearProblem
  {
    /// r(u) with ghost values of u up to date; 0 in imposed unknowns. Throws InvertedPoint on all
    /// ranks or none.
    std::function<void(const Vector &u, Vector &r)> residual;

    /// What the line search looks at in place of the residual, with the same value where the
    /// tangent was taken last. May be empty: the residual.
    std::function<void(const Vector &u, Vector &r)> search_residual;

    /// Assembles the tangent K = dr/du at u, ready for solve().
    std::function<void(const Vector &u)> linearise;

    /// Solves K du = -r where du equals `imposed` in the imposed unknowns (the predictor: the
    /// imposed increment enters through the tangent). Returns the linear iterations. `imposed` is 0
    /// elsewhere.
    std::function<unsigned int(const Vector &r, const Vector &imposed, Vector &du)> solve;

    /// What is still missing in the imposed unknowns: target - u there, 0 elsewhere. May be empty:
    /// none imposed.
    std::function<void(const Vector &u, Vector &missing)> missing_imposed;

    /// Norm by which a residual is judged small, e.g. that of the applied forces and reactions at
    /// u.
    std::function<double(const Vector &u)> force_scale;
  };

  struct NewtonParameters
  {
    double residual_tolerance   = 1e-10; // relative to force_scale
    double update_tolerance     = 1e-10; // |du| / |u|
    unsigned int max_iterations = 30;
    unsigned int max_halvings   = 12; // of a step in the line search

    /// Declares the entries in the section that is open, `Solver`.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What an iteration looked like, for progress and for the record.
  struct NewtonIteration
  {
    unsigned int iteration         = 0;
    double residual                = 0; // relative
    double update                  = 0; // relative
    double step                    = 1; // what the line search left of the full step
    unsigned int linear_iterations = 0;
  };

  struct NewtonResult
  {
    bool converged                 = false;
    unsigned int iterations        = 0;
    unsigned int linear_iterations = 0;
    std::string reason; // why not converged, one clause
  };

  /// Solves r(u) = 0 from u, which is changed to the best that was reached; its ghost values are up
  /// to date then.
  ///
  /// Converged by either criterion of Brunet, algorithm 1, with nothing of the imposed values
  /// missing: the residual, here relative to force_scale(u) and not to its first value, which says
  /// nothing where imposed values are still to enter; or the update of a full step. Where rounding
  /// hides the energy that a step could gain, and the residual falls by less than a tenth or the
  /// step had to be shortened much, it counts as converged too.
  ///
  /// The line search halves the whole step, its imposed part included, until nothing is inverted
  /// (InvertedPoint, or a residual that is not finite) and the residual or the energy goes down;
  /// the energy is judged by its slope du . r at both ends. While imposed values are entering the
  /// residual may rise, and only inversion counts. What a shortened step left out of the imposed
  /// values is entered by the next one. A linear solve that ends in NotConverged ends the run, with
  /// its message as the reason.
  NewtonResult newton_raphson(const NonlinearProblem &problem,
                              const NewtonParameters &parameters,
                              Vector &u,
                              const std::function<void(const NewtonIteration &)> &report = {});
} // namespace softcell
