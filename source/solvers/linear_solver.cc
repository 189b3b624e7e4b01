// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients, GMRES and what does not depend on the backend.

#include <softcell/solvers/linear_solver.h>

#include <softcell/base/exceptions.h>
#include <softcell/solvers/approximate_inverse.h>
#include <softcell/solvers/dot.h>
#include <softcell/solvers/lanczos.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace softcell
{
  namespace
  {
    std::string in_short(const double number)
    {
      std::ostringstream text;
      text.precision(2);
      text << number;
      return text.str();
    }

    class Jacobi : public ApproximateInverse
    {
    public:
      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> & /*positions*/,
                      const std::vector<unsigned int> & /*constrained*/) override
      {
        inverse_diagonal_ = matrix.diagonal();
        // Positive even where an indefinite matrix has a negative one; 1 in an empty row.
        for (double &entry : inverse_diagonal_)
          entry = entry != 0 ? 1 / std::abs(entry) : 1.;
      }

      void vmult(Vector &y, const Vector &x) const override
      {
        std::transform(inverse_diagonal_.begin(), inverse_diagonal_.end(), x.begin(), y.begin(),
                       std::multiplies<>());
      }

    private:
      Vector inverse_diagonal_;
    };

    class DirectSolver : public LinearSolver
    {
    public:
      explicit DirectSolver(const bool is_symmetric)
          : factors_(make_petsc_inverse(is_symmetric ? Approximation::symmetric_factors
                                                     : Approximation::factors))
      {
      }

      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> &positions,
                      const std::vector<unsigned int> &constrained) override
      {
        matrix_ = &matrix;
        factors_->set_matrix(matrix, positions, constrained);
      }

      unsigned int solve(Vector &x, const Vector &b) const override
      {
        x.zero_out_ghost_values();
        factors_->vmult(x, b);
        Vector Ax(matrix_->partitioner());
        matrix_->vmult(Ax, x);
        Ax -= b;
        const double residual = std::sqrt(dot(Ax, Ax)), b_norm = std::sqrt(dot(b, b));
        history_.assign(1, b_norm == 0 ? residual : residual / b_norm);
        if (!(history_[0] <= acceptable_residual)) // so written that a NaN fails
          throw NotConverged("the direct solver leaves a relative residual of " +
                             in_short(history_[0]) + ": the matrix is singular or nearly so");
        return 1;
      }

      const std::vector<double> &history() const override
      {
        return history_;
      }

      double condition() const override
      {
        return std::numeric_limits<double>::quiet_NaN();
      }

    private:
      static constexpr double acceptable_residual = 1e-5;
      std::unique_ptr<ApproximateInverse> factors_;
      const BlockMatrix *matrix_ = nullptr;
      mutable std::vector<double> history_;
    };

    class IterativeSolver : public LinearSolver
    {
    public:
      /// @param inverse none if null.
      IterativeSolver(const LinearSolverParameters &parameters,
                      std::unique_ptr<ApproximateInverse> inverse)
          : parameters_(parameters), inverse_(std::move(inverse))
      {
      }

      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> &positions,
                      const std::vector<unsigned int> &constrained) override
      {
        matrix_ = &matrix;
        if (inverse_)
          inverse_->set_matrix(matrix, positions, constrained);
      }

      const std::vector<double> &history() const override
      {
        return history_;
      }

    protected:
      /// Sets x to 0. @return the norm of b; if that is 0, x is the solution.
      double start(Vector &x, const Vector &b) const
      {
        history_.clear();
        x.zero_out_ghost_values();
        x = 0.;
        return std::sqrt(finite_dot(b, b));
      }

      double finite_dot(const Vector &x, const Vector &y) const
      {
        const double product = dot(x, y);
        if (!std::isfinite(product))
          fail("met a number that is not finite");
        return product;
      }

      [[noreturn]] void fail(const std::string &what) const
      {
        throw NotConverged(name() + " with the preconditioner " + parameters_.preconditioner + ' ' +
                           what);
      }

      [[noreturn]] void fail_at_the_limit() const
      {
        fail("reached a relative residual of " + in_short(history_.back()) + " instead of " +
             in_short(parameters_.tolerance) + " in " + std::to_string(parameters_.max_iterations) +
             " iterations (" +
             (parameters_.preconditioner == "AMG" ? "'Solver/Linear solver = direct'"
                                                  : "'Solver/Preconditioner = AMG'") +
             " may do better)");
      }

      /// Within a message.
      virtual std::string name() const = 0;

      const LinearSolverParameters parameters_;
      std::unique_ptr<ApproximateInverse> inverse_;
      const BlockMatrix *matrix_ = nullptr;
      mutable std::vector<double> history_;
    };

    class ConjugateGradients : public IterativeSolver
    {
    public:
      using IterativeSolver::IterativeSolver;

      unsigned int solve(Vector &x, const Vector &b) const override;
      double condition() const override;

    private:
      std::string name() const override
      {
        return "conjugate gradients";
      }

      mutable LanczosMatrix lanczos_;
    };

    unsigned int ConjugateGradients::solve(Vector &x, const Vector &b) const
    {
      lanczos_.clear();
      const double b_norm = start(x, b);
      if (b_norm == 0)
        return 0;
      Vector r(matrix_->partitioner()), z(r), p(r), Ap(r);
      std::copy_n(b.begin(), b.locally_owned_size(), r.begin());

      double rz_before = 1;
      for (unsigned int iteration = 1; iteration <= parameters_.max_iterations; ++iteration)
      {
        if (inverse_)
          inverse_->vmult(z, r);
        else
          z = r;
        const double rz    = finite_dot(r, z);
        const double share = iteration > 1 ? rz / rz_before : 0.; // of the last direction
        p.sadd(share, 1., z);
        matrix_->vmult(Ap, p);
        const double pAp = finite_dot(p, Ap);
        if (rz <= 0 || pAp <= 0) // the preconditioner or the matrix is indefinite
        {
          if (iteration == 1 && rz <= 0)
            fail("cannot start: the preconditioner is not positive definite");
          if (iteration == 1) // as long as if the curvature had the other sign
            x.equ(pAp < 0 ? -rz / pAp : 1., p);
          lanczos_.clear();
          return iteration;
        }
        x.add(rz / pAp, p);
        r.add(-rz / pAp, Ap);
        lanczos_.add(pAp / rz, share);
        rz_before = rz;
        history_.push_back(std::sqrt(finite_dot(r, r)) / b_norm);
        if (history_.back() <= parameters_.tolerance)
          return iteration;
      }
      fail_at_the_limit();
    }

    double ConjugateGradients::condition() const
    {
      const auto [smallest, largest] = lanczos_.extreme_eigenvalues();
      return largest / smallest;
    }

    /// Preconditioned from the right, so that it looks at the true residual.
    class GMRES : public IterativeSolver
    {
    public:
      using IterativeSolver::IterativeSolver;

      unsigned int solve(Vector &x, const Vector &b) const override;

      double condition() const override
      {
        return std::numeric_limits<double>::quiet_NaN();
      }

    private:
      std::string name() const override
      {
        return "GMRES";
      }
    };

    unsigned int GMRES::solve(Vector &x, const Vector &b) const
    {
      const double b_norm = start(x, b);
      if (b_norm == 0)
        return 0;

      struct Product // deal.II never sees a number that is not finite
      {
        std::function<void(Vector &, const Vector &)> vmult;
      };
      const Product matrix{[this](Vector &y, const Vector &v) {
        matrix_->vmult(y, v);
        finite_dot(y, y);
      }};
      const Product inverse{[this](Vector &y, const Vector &v) {
        if (inverse_)
          inverse_->vmult(y, v);
        else
          y = v;
        finite_dot(y, y);
      }};

      constexpr unsigned int restart = 100;
      using Solver                   = dealii::SolverGMRES<Vector>;
      dealii::SolverControl control(parameters_.max_iterations, parameters_.tolerance * b_norm,
                                    false, false);
      dealii::PrimitiveVectorMemory<Vector> memory;
      Solver solver(control, memory, Solver::AdditionalData(restart + 2, true));
      solver.connect([&](const unsigned int iteration, const double residual, const Vector &) {
        if (iteration > history_.size()) // not the start, nor once more at a restart
          history_.push_back(residual / b_norm);
        return dealii::SolverControl::success;
      });
      try
      {
        solver.solve(matrix, x, b, inverse);
      }
      catch (const dealii::SolverControl::NoConvergence &)
      {
        fail_at_the_limit();
      }
      return control.last_step();
    }
  } // namespace

  void LinearSolverParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Linear solver", solver,
                      "Conjugate gradients (GMRES if a pressure acts, whose tangent is not "
                      "symmetric), or a direct factorisation by MUMPS, which needs much memory but "
                      "minds neither bad cuts nor slender bodies.",
                      dealii::Patterns::Selection("CG|direct"));
    prm.add_parameter(
      "Preconditioner", preconditioner,
      "Of the iterative solver. AMG keeps the six rigid-body motions; its "
      "iterations hardly grow with the number of unknowns. Incomplete Cholesky is "
      "that of each rank's own part. Geometric multigrid makes do without a matrix, "
      "several times as fast and with a fraction of the memory, for cells of "
      "degree 1 and one size, one material, and one rank with OMP_NUM_THREADS "
      "threads.",
      dealii::Patterns::Selection("none|Jacobi|incomplete Cholesky|AMG|geometric multigrid"));
    prm.add_parameter("Backend", backend,
                      "Whose preconditioners are used: ML and Ifpack of Trilinos, or GAMG and ICC "
                      "of PETSc.",
                      dealii::Patterns::Selection("Trilinos|PETSc"));
    prm.add_parameter(
      "Linear tolerance", tolerance,
      "Residual of the linear system relative to its right-hand side. Newton's method "
      "mends what a loose one leaves, by an iteration more. Units: 1",
      dealii::Patterns::Double(0., 1.));
    prm.add_parameter("Linear iterations", max_iterations,
                      "Iterations of the iterative solver after which a solve has failed.",
                      dealii::Patterns::Integer(1));
  }

  std::vector<Vector> rigid_body_modes(const std::shared_ptr<const Partitioner> &unknowns,
                                       const std::vector<Point> &positions,
                                       const std::vector<unsigned int> &constrained)
  {
    const unsigned int n_owned = unknowns->locally_owned_size() / 3;
    Direction center;
    for (unsigned int i = 0; i < n_owned; ++i)
      center += positions[i] / (unknowns->size() / 3.);
    center = dealii::Utilities::MPI::sum(center, unknowns->get_mpi_communicator());

    std::vector<Vector> modes;
    for (unsigned int m = 0; m < 6; ++m)
    {
      Direction axis;
      axis[m % 3] = 1;
      Vector mode(unknowns);
      for (unsigned int i = 0; i < n_owned; ++i)
      {
        const Direction motion =
          m < 3 ? axis : dealii::cross_product_3d(axis, Direction(positions[i]) - center);
        for (unsigned int c = 0; c < 3; ++c)
          mode.local_element(3 * i + c) = motion[c];
      }
      for (const unsigned int unknown : constrained)
        if (unknown < 3 * n_owned)
          mode.local_element(unknown) = 0.;

      const double length = mode.l2_norm();
      for (const Vector &other : modes)
        mode.add(-(other * mode), other);
      const double rest = mode.l2_norm();
      if (rest > 1e-8 * length)
        modes.push_back(mode *= 1 / rest);
    }
    return modes;
  }

  std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverParameters &parameters,
                                                   const bool is_symmetric)
  {
    if (parameters.solver == "direct")
      return std::make_unique<DirectSolver>(is_symmetric);

    std::unique_ptr<ApproximateInverse> inverse;
    if (parameters.preconditioner == "Jacobi")
      inverse = std::make_unique<Jacobi>();
    else if (parameters.preconditioner != "none")
    {
      const auto approximation = parameters.preconditioner == "AMG"
                                   ? Approximation::multigrid
                                   : Approximation::incomplete_cholesky;
      inverse                  = parameters.backend == "PETSc" ? make_petsc_inverse(approximation)
                                                               : make_trilinos_inverse(approximation);
    }
    if (is_symmetric)
      return std::make_unique<ConjugateGradients>(parameters, std::move(inverse));
    return std::make_unique<GMRES>(parameters, std::move(inverse));
  }
} // namespace softcell
