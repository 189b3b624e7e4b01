// SPDX-License-Identifier: LGPL-2.1-or-later
// Linear systems with an assembled tangent, by Trilinos or PETSc.
#pragma once

#include <softcell/base/block_matrix.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  struct LinearSolverParameters
  {
    std::string solver = "CG"; // CG, direct (MUMPS)
    std::string preconditioner =
      "AMG"; // none, Jacobi, incomplete Cholesky, AMG, geometric multigrid
    std::string backend         = "Trilinos"; // Trilinos, PETSc
    double tolerance            = 1e-4;       // relative to |b|
    unsigned int max_iterations = 5000;

    bool is_matrix_free() const
    {
      return solver == "CG" && preconditioner == "geometric multigrid";
    }

    /// Declares the entries in the section that is open, `Solver`.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// A linear solver that keeps its symbolic work (sparsity, graph) between matrices of the same
  /// structure.
  ///
  /// The conjugate gradients and the product with the matrix are our own, the GMRES for
  /// unsymmetric matrices is that of deal.II: the same for both backends. These supply incomplete
  /// factors and multigrid; MUMPS comes through PETSc with either.
  class LinearSolver
  {
  public:
    virtual ~LinearSolver() = default;

    /// Takes the values of the matrix and builds the preconditioner or the factors. The structure
    /// must be that of the first call. The matrix is looked at by solve(): keep it, unchanged,
    /// until then.
    /// @param matrix symmetric, if the solver was made for that.
    /// @param positions reference positions of the owned nodes (and perhaps of more), for the six
    /// rigid-body modes
    ///                  that AMG keeps.
    /// @param constrained owned local unknowns whose rows and columns are those of the identity;
    /// ghosts may follow.
    /// @throws NotConverged if a factorisation breaks down
    virtual void set_matrix(const BlockMatrix &matrix,
                            const std::vector<Point> &positions,
                            const std::vector<unsigned int> &constrained) = 0;

    /// Solves A x = b from x = 0 and returns the iterations (1 for a direct solver). An indefinite
    /// matrix (negative curvature in CG) ends the iteration with the best x so far, which is a
    /// direction of descent of the energy x.Ax / 2 - x.b. Ghost values of x are not updated.
    /// @throws NotConverged, also where a number is no longer finite
    virtual unsigned int solve(Vector &x, const Vector &b) const = 0;

    /// |b - A x| / |b| after each iteration of the last solve().
    virtual const std::vector<double> &history() const = 0;

    /// Condition number of the preconditioned matrix as the last solve() saw it: the ratio of the
    /// extreme eigenvalues of the Lanczos matrix that conjugate gradients make along their way. It
    /// is at most the true one, from which it differs by what b has no share in. NaN from other
    /// solvers, and where the matrix or the preconditioner is indefinite. Source: Saad, Iterative
    /// Methods for Sparse Linear Systems (2003), sec. 6.7.3.
    virtual double condition() const = 0;
  };

  /// @param is_symmetric false for matrices that need not be: LU takes the place of LDL^T, and
  /// GMRES that of the conjugate gradients.
  std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverParameters &parameters,
                                                   bool is_symmetric = true);
} // namespace softcell
