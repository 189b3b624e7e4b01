// SPDX-License-Identifier: LGPL-2.1-or-later
// Linear systems without a matrix, on uniform grids.

#include <softcell/solvers/matrix_free_solver.h>

#include <softcell/base/exceptions.h>

#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    std::vector<std::size_t> entries_of(const std::vector<unsigned int> &unknowns,
                                        const CellLattice &cells)
    {
      std::vector<std::size_t> entries;
      for (const unsigned int unknown : unknowns)
        entries.push_back(unknown % 3 * cells.nodes.size() + cells.entries[unknown / 3]);
      return entries;
    }

    void add(Vector &to, const LatticeVector<double> &from, const std::vector<std::size_t> &entries)
    {
      for (unsigned int c = 0; c < dim; ++c)
        for (std::size_t node = 0; node < entries.size(); ++node)
          to.local_element(3 * node + c) += from.component(c)[entries[node]];
    }
  } // namespace

  MatrixFreeSolver::MatrixFreeSolver(const Discretization &discretization,
                                     const Material &material,
                                     const std::vector<unsigned int> &constrained,
                                     const LinearSolverParameters &parameters)
      : MatrixFreeSolver(cell_lattice(discretization), material, constrained, parameters)
  {
  }

  MatrixFreeSolver::MatrixFreeSolver(const CellLattice &cells,
                                     const Material &material,
                                     const std::vector<unsigned int> &constrained,
                                     const LinearSolverParameters &parameters)
      : parameters_(parameters),
        entries_(cells.entries),
        multigrid_(cells, material, entries_of(constrained, cells), smoother_degree),
        tangent_(cells, material, multigrid_.unknowns()),
        state_(cells.nodes),
        float_r_(cells.nodes),
        float_z_(cells.nodes),
        x_(cells.nodes),
        r_(cells.nodes),
        z_(cells.nodes),
        p_(cells.nodes),
        Kp_(cells.nodes)
  {
  }

  void MatrixFreeSolver::add_internal_force(const Vector &u, Vector &r) const
  {
    copy(u, entries_, x_);
    tangent_.elasticity().residual(x_, r_);
    add(r, r_, entries_);
  }

  void MatrixFreeSolver::set_state(const Vector &u)
  {
    copy(u, entries_, x_);
    tangent_.elasticity().set_state(x_);
    copy(u, entries_, state_);
  }

  void MatrixFreeSolver::add_product(Vector &y, const Vector &x) const
  {
    copy(x, entries_, p_);
    tangent_.elasticity().vmult(Kp_, p_);
    add(y, Kp_, entries_);
  }

  void MatrixFreeSolver::set_matrix(const BlockMatrix &supports,
                                    const std::vector<Point> & /*positions*/,
                                    const std::vector<unsigned int> & /*constrained*/)
  {
    tangent_.supports() = LatticeMatrix<double>(supports, entries_, x_.lattice());
    multigrid_.set_state(state_, LatticeMatrix<float>(tangent_.supports()), Tangent::exact);
  }

  double MatrixFreeSolver::finite_dot(const LatticeVector<double> &x,
                                      const LatticeVector<double> &y) const
  {
    const double product = multigrid_.unknowns().dot(x, y);
    if (!std::isfinite(product))
      fail("met a number that is not finite");
    return product;
  }

  void MatrixFreeSolver::fail(const std::string &what) const
  {
    throw NotConverged("conjugate gradients with geometric multigrid " + what);
  }

  unsigned int MatrixFreeSolver::solve(Vector &x, const Vector &b) const
  {
    unsigned int iterations = iterate(Tangent::exact, b);
    if (is_indefinite_) // of which the exact smoother shows little else
      iterations += iterate(Tangent::definite, b);
    x.zero_out_ghost_values();
    copy(x_, entries_, x);
    return iterations;
  }

  /// Solves K x = b from x = 0, or up to negative curvature.
  unsigned int MatrixFreeSolver::iterate(const Tangent smoother, const Vector &b) const
  {
    multigrid_.set_smoother(smoother);
    is_indefinite_ = false;
    history_.clear();
    lanczos_.clear();
    std::fill(x_.entries().begin(), x_.entries().end(), 0.);
    std::fill(p_.entries().begin(), p_.entries().end(), 0.);
    const LatticeUnknowns &unknowns = multigrid_.unknowns();
    copy(b, entries_, r_);
    unknowns.hold(r_);
    const double b_norm = std::sqrt(finite_dot(r_, r_));
    if (b_norm == 0)
      return 0;
    const auto axpy = [&](auto &y, const double a, const auto &x) {
      unknowns.for_each(y, x, [a](double &y_i, const double x_i) { y_i += a * x_i; });
    };
    double rz_before = 1;
    for (unsigned int iteration = 1; iteration <= parameters_.max_iterations; ++iteration)
    {
      unknowns.for_each(float_r_, r_, [](float &y_i, const double x_i) { y_i = float(x_i); });
      multigrid_.vmult(float_z_, float_r_);
      unknowns.for_each(z_, float_z_, [](double &y_i, const float x_i) { y_i = x_i; });
      const double rz    = finite_dot(r_, z_);
      const double share = iteration > 1 ? rz / rz_before : 0.;
      unknowns.for_each(p_, z_,
                        [share](double &p_i, const double z_i) { p_i = share * p_i + z_i; });
      tangent_.vmult(Kp_, p_);
      const double curvature = finite_dot(p_, Kp_);
      is_indefinite_         = curvature <= 0 || rz <= 0; // the tangent, or multigrid as rounded
      if (is_indefinite_)
      {
        if (iteration == 1 && rz <= 0 && smoother == Tangent::definite)
          fail("cannot start: the preconditioner is not positive definite");
        if (iteration == 1) // as long as if the curvature had the other sign
          axpy(x_, curvature < 0 ? -rz / curvature : 1., p_);
        lanczos_.clear();
        return iteration;
      }
      axpy(x_, rz / curvature, p_);
      axpy(r_, -rz / curvature, Kp_);
      lanczos_.add(curvature / rz, share);
      rz_before = rz;
      history_.push_back(std::sqrt(finite_dot(r_, r_)) / b_norm);
      if (history_.back() <= parameters_.tolerance)
        return iteration;
    }
    std::ostringstream text;
    text.precision(2);
    text << "reached a relative residual of " << history_.back() << " instead of "
         << parameters_.tolerance << " in " << parameters_.max_iterations << " iterations";
    fail(text.str());
  }

  double MatrixFreeSolver::condition() const
  {
    const auto [smallest, largest] = lanczos_.extreme_eigenvalues();
    return largest / smallest;
  }

  std::size_t MatrixFreeSolver::memory() const
  {
    return multigrid_.memory() + tangent_.memory() +
           x_.entries().size() * (5 * sizeof(double) + 3 * sizeof(float));
  }
} // namespace softcell
