// SPDX-License-Identifier: LGPL-2.1-or-later
// A discretized body with its loads and supports, as a nonlinear system of equations.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/base/console.h>
#include <softcell/loads/load_list.h>
#include <softcell/operators/elasticity.h>
#include <softcell/operators/stabilization.h>
#include <softcell/solvers/linear_solver.h>
#include <softcell/solvers/matrix_free_solver.h>
#include <softcell/solvers/newton.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// The equilibrium r(u; t) = internal forces - external forces = 0 at load factor t, with imposed
  /// unknowns.
  ///
  /// Brunet eq. 2.22 and 2.28, with the sign of the latter mended: K du = -r.
  class Model
  {
  public:
    /// @param has_projection of the volumetric strain, see Elasticity.
    /// @param timers collects `assembly`, `preconditioner` and `linear solver`.
    Model(const Discretization &discretization,
          const std::vector<Material> &materials,
          bool has_projection,
          const Loads &loads,
          const LinearSolverParameters &linear_solver,
          Timers &timers);

    /// Load factor t of all that follows.
    void set_load(double t);

    /// Refers to this model.
    NonlinearProblem equations();

    /// The forces by which named regions are held or loaded at u, in the order of the loads. Units:
    /// N
    std::vector<std::pair<std::string, Direction>> region_forces(const Vector &u) const;

    const Elasticity &elasticity() const
    {
      return elasticity_;
    }
    const Stabilization &stabilization() const
    {
      return stabilization_;
    }

    /// Potential energy of loads and supports; NaN if one of them has none. Units: J
    double load_energy(const Vector &u) const;

    /// Linear residuals of the last solve, relative.
    const std::vector<double> &linear_residuals() const
    {
      return linear_solver_->history();
    }

    /// LinearSolver::condition() of the last solve.
    double condition() const
    {
      return linear_solver_->condition();
    }

  private:
    /// @param base as of Elasticity.
    void residual(const Vector &u, Vector &r, const Vector *base = nullptr);
    void linearise(const Vector &u);
    unsigned int solve(const Vector &r, const Vector &imposed, Vector &du);
    /// Internal less external forces in all unknowns, the imposed ones too.
    void unconstrained_residual(const Vector &u,
                                Vector &internal,
                                Vector &external,
                                const Vector *base = nullptr) const;

    const Discretization &discretization_;
    Elasticity elasticity_;
    Stabilization stabilization_;
    const Loads &loads_;
    std::unique_ptr<LinearSolver> linear_solver_;
    MatrixFreeSolver *matrix_free_; // the linear solver, if it makes do without a matrix
    BlockMatrix tangent_;           // then of the loads alone
    Timers &timers_;
    bool has_projection_;
    bool has_base_      = false; // base_ is of this load factor
    double load_factor_ = 0;
    double force_scale_ = 0; // of the last residual
    double diagonal_    = 1; // of imposed rows
    Vector internal_, external_;
    Vector base_; // where the tangent was taken last, if there is a projection
    Vector lift_; // K times what is missing of the imposed displacement, from before K lost these
                  // columns
  };
} // namespace softcell
