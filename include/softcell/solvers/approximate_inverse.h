// SPDX-License-Identifier: LGPL-2.1-or-later
// What Trilinos and PETSc supply to the linear solver: incomplete factors, multigrid, a
// factorisation.
#pragma once

#include <softcell/base/block_matrix.h>

#include <memory>
#include <vector>

namespace softcell
{
  enum class Approximation
  {
    incomplete_cholesky, // of this rank's diagonal block
    multigrid,           // algebraic, smoothed aggregation that keeps the rigid-body modes
    symmetric_factors,   // LDL^T by MUMPS: not an approximation
    factors              // LU by MUMPS
  };

  /// An operator that is near to A^-1, and symmetric where A is. Incomplete Cholesky takes one
  /// triangle of A for both. Its symbolic work is kept between matrices of the same structure.
  class ApproximateInverse
  {
  public:
    virtual ~ApproximateInverse() = default;

    /// See LinearSolver::set_matrix(). @throws NotConverged if the factorisation breaks down
    virtual void set_matrix(const BlockMatrix &matrix,
                            const std::vector<Point> &positions,
                            const std::vector<unsigned int> &constrained) = 0;

    /// y = A^-1 x, nearly. Collective.
    virtual void vmult(Vector &y, const Vector &x) const = 0;
  };

  /// Incomplete factors by Ifpack, multigrid by ML.
  std::unique_ptr<ApproximateInverse> make_trilinos_inverse(Approximation approximation);

  /// ICC, GAMG, and MUMPS.
  std::unique_ptr<ApproximateInverse> make_petsc_inverse(Approximation approximation);

  /// The translations and rotations of the nodes, zero in the constrained unknowns, orthonormal;
  /// fewer than six if the constraints leave fewer. Collective.
  std::vector<Vector> rigid_body_modes(const std::shared_ptr<const Partitioner> &unknowns,
                                       const std::vector<Point> &positions,
                                       const std::vector<unsigned int> &constrained);
} // namespace softcell
