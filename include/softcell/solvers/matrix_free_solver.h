// SPDX-License-Identifier: LGPL-2.1-or-later
// Linear systems without a matrix, on uniform grids.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/lanczos.h>
#include <softcell/solvers/linear_solver.h>

namespace softcell
{
  /// Conjugate gradients in double precision with geometric multigrid in single precision, whose
  /// smoother has the exact tangent; where they meet negative curvature they start again with the
  /// definite one. Each attempt may take as many iterations as the parameters allow; history() is
  /// that of the last one.
  ///
  /// The body's own stiffness is no matrix but that of a displacement, set_state(); what supports
  /// add to it is the matrix of set_matrix(). The constrained unknowns are always the same.
  class MatrixFreeSolver : public LinearSolver
  {
  public:
    /// On the finest grid. At rest a system takes as long with 4, in more iterations.
    static constexpr unsigned int smoother_degree = 6;

    /// @param constrained  unknowns.
    /// @throws BadInput see cell_lattice()
    MatrixFreeSolver(const Discretization &discretization,
                     const Material &material,
                     const std::vector<unsigned int> &constrained,
                     const LinearSolverParameters &parameters);

    /// @param cells  with entries for the nodes.
    MatrixFreeSolver(const CellLattice &cells,
                     const Material &material,
                     const std::vector<unsigned int> &constrained,
                     const LinearSolverParameters &parameters);

    /// Adds the internal force to r. Units: N. @throws InvertedPoint
    void add_internal_force(const Vector &u, Vector &r) const;

    /// Takes the displacement at which the tangent is formed. @throws InvertedPoint
    void set_state(const Vector &u);

    /// Adds the body's own tangent times x, without constraints. Units: N
    void add_product(Vector &y, const Vector &x) const;

    void set_matrix(const BlockMatrix &supports,
                    const std::vector<Point> &positions,
                    const std::vector<unsigned int> &constrained) override;
    unsigned int solve(Vector &x, const Vector &b) const override;

    const std::vector<double> &history() const override
    {
      return history_;
    }
    double condition() const override;

    /// Units: byte
    std::size_t memory() const;

  private:
    double finite_dot(const LatticeVector<double> &x, const LatticeVector<double> &y) const;
    [[noreturn]] void fail(const std::string &what) const;
    unsigned int iterate(Tangent smoother, const Vector &b) const;

    LinearSolverParameters parameters_;
    std::vector<std::size_t> entries_;            // (nodes) in a LatticeField
    mutable GeometricMultigrid<float> multigrid_; // its smoother changes
    LatticeTangent<double> tangent_;
    LatticeVector<float> state_;
    mutable LatticeVector<float> float_r_, float_z_;
    mutable LatticeVector<double> x_, r_, z_, p_, Kp_;
    mutable LanczosMatrix lanczos_;
    mutable bool is_indefinite_ = false; // what the last attempt met
    mutable std::vector<double> history_;
  };
} // namespace softcell
