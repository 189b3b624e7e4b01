// SPDX-License-Identifier: LGPL-2.1-or-later
// The V-cycle and its smoother.

#include <softcell/solvers/geometric_multigrid.h>

#include <softcell/base/exceptions.h>
#include <softcell/solvers/grid_levels.h>
#include <softcell/solvers/lanczos.h>

#include <deal.II/lac/vector.h>

namespace softcell
{
  template <class Real>
  struct GeometricMultigrid<Real>::Level
  {
    /// @param own  the level's free unknowns
    Level(const CellLattice &cells,
          const Material &material,
          LatticeUnknowns own,
          const unsigned int smoother_degree)
        : degree(smoother_degree),
          spacing(cells.spacing),
          unknowns(std::move(own)),
          tangent(cells, material, unknowns),
          inverse_diagonal(cells.nodes),
          x(cells.nodes),
          r(cells.nodes),
          d(cells.nodes),
          Kd(cells.nodes)
    {
    }

    unsigned int degree; // of the smoother
    Direction spacing;
    LatticeUnknowns unknowns;
    LatticeTangent<Real> tangent;
    LatticeBlocks<Real> inverse_diagonal;
    Real largest_eigenvalue = 1; // of the inverse diagonal times the tangent
    LatticeVector<Real> x, r, d, Kd;

    /// d = a d + b D^-1 r
    void precondition(const Real a, const Real b)
    {
      unknowns.for_each_run([&](const std::size_t begin, const std::size_t end) {
        const Real *D[6], *const r_x = r.component(0), *const r_y = r.component(1),
                                 *const r_z = r.component(2);
        Real *const d_x = d.component(0), *const d_y = d.component(1), *const d_z = d.component(2);
        for (unsigned int k = 0; k < 6; ++k)
          D[k] = inverse_diagonal.component(k);
#pragma omp simd
        for (std::size_t i = begin; i < end; ++i)
        {
          const Real x_i = b * r_x[i], y_i = b * r_y[i], z_i = b * r_z[i];
          d_x[i] = a * d_x[i] + D[0][i] * x_i + D[5][i] * y_i + D[4][i] * z_i;
          d_y[i] = a * d_y[i] + D[5][i] * x_i + D[1][i] * y_i + D[3][i] * z_i;
          d_z[i] = a * d_z[i] + D[4][i] * x_i + D[3][i] * y_i + D[2][i] * z_i;
        }
      });
    }

    /// x += d, and r -= K d unless r is no longer needed.
    void step(const bool is_last = false)
    {
      unknowns.for_each(x, d, [](Real &x_i, const Real d_i) { x_i += d_i; });
      if (is_last)
        return;
      tangent.vmult(Kd, d);
      unknowns.for_each(r, Kd, [](Real &r_i, const Real Kd_i) { r_i -= Kd_i; });
    }
  };

  template <class Real>
  GeometricMultigrid<Real>::GeometricMultigrid(const CellLattice &cells,
                                               const Material &material,
                                               const std::vector<std::size_t> &held,
                                               unsigned int degree)
  {
    const Material law = material.definite();
    for (GridLevel &level : grid_levels(cells, held))
    {
      levels_.push_back(
        std::make_unique<Level>(level.cells, law, std::move(level.unknowns), degree));
      degree *= 2;
    }
    coarsest_entries_ = levels_.back()->unknowns.free_entries();
  }

  template <class Real>
  void GeometricMultigrid<Real>::combine(const Real stiffness, const Real mass)
  {
    for (auto &level : levels_)
      level->tangent.combine(stiffness, mass);
  }

  template <class Real>
  GeometricMultigrid<Real>::~GeometricMultigrid() = default;

  template <class Real>
  const LatticeUnknowns &GeometricMultigrid<Real>::unknowns() const
  {
    return levels_[0]->unknowns;
  }

  template <class Real>
  void GeometricMultigrid<Real>::set_state(const LatticeVector<Real> &u,
                                           LatticeMatrix<Real> supports,
                                           const Tangent smoother)
  {
    smoother_                 = levels_.size() > 1 ? smoother : Tangent::definite;
    LatticeVector<Real> state = u;
    levels_[0]->tangent.elasticity().set_state(state, smoother_);
    levels_[0]->tangent.supports() = std::move(supports);
    for (unsigned int l = 1; l < levels_.size(); ++l)
    {
      const Level &fine = *levels_[l - 1];
      Level &coarse     = *levels_[l];
      LatticeVector<Real> coarse_state =
        coarse_displacement(fine.unknowns, state, coarse.unknowns, coarse.spacing);
      try
      {
        coarse.tangent.elasticity().set_state(coarse_state, Tangent::definite);
      }
      catch (const InvertedPoint &)
      {
        const LatticeVector<Real> rest(coarse.unknowns.nodes());
        coarse.tangent.elasticity().set_state(rest, Tangent::definite);
      }
      coarse.tangent.supports() = LatticeMatrix<Real>(levels_[l - 1]->tangent.supports(),
                                                      fine.unknowns, coarse.unknowns.nodes());
      state                     = std::move(coarse_state);
    }
    for (unsigned int l = 0; l + 1 < levels_.size(); ++l)
    {
      levels_[l]->tangent.inverse_diagonal(levels_[l]->inverse_diagonal);
      estimate_eigenvalue(*levels_[l], l == 0 ? smoother_ : Tangent::definite);
    }
    invert_coarsest();
  }

  template <class Real>
  void GeometricMultigrid<Real>::set_smoother(const Tangent tangent)
  {
    if (levels_.size() == 1 || tangent == smoother_)
      return;
    smoother_ = tangent;
    levels_[0]->tangent.elasticity().set_tangent(tangent);
    estimate_eigenvalue(*levels_[0], tangent);
  }

  template <class Real>
  void GeometricMultigrid<Real>::estimate_eigenvalue(Level &level, const Tangent tangent) const
  {
    const LatticeUnknowns &unknowns = level.unknowns;
    LatticeVector<Real> p(unknowns.nodes());
    level.r = rough_field<Real>(unknowns);

    LanczosMatrix lanczos;
    double rz_before = 1;
    for (unsigned int step = 0; step < n_eigenvalue_steps; ++step)
    {
      level.precondition(0, 1);
      const double rz  = unknowns.dot(level.r, level.d);
      const Real share = step > 0 ? rz / rz_before : 0.;
      unknowns.for_each(p, level.d, [&](Real &p_i, const Real z_i) { p_i = share * p_i + z_i; });
      level.tangent.vmult(level.Kd, p);
      const double curvature = unknowns.dot(p, level.Kd) / rz;
      if (!(rz > 0) || (tangent == Tangent::definite && !(curvature > 0)))
        break;
      unknowns.for_each(level.r, level.Kd,
                        [&](Real &r_i, const Real Kp_i) { r_i -= Kp_i / Real(curvature); });
      lanczos.add(curvature, share);
      rz_before = rz;
    }
    const double largest = lanczos.extreme_eigenvalues().second;
    if (!(largest > 0))
      throw NotConverged("geometric multigrid met a grid whose tangent is not positive definite");
    level.largest_eigenvalue = eigenvalue_margin * largest;
  }

  template <class Real>
  void GeometricMultigrid<Real>::invert_coarsest()
  {
    Level &level        = *levels_.back();
    const std::size_t n = coarsest_entries_.size();
    coarsest_inverse_.reinit(n, n);
    level.d = LatticeVector<Real>(level.unknowns.nodes());
    for (std::size_t j = 0; j < n; ++j)
    {
      level.d.entries()[coarsest_entries_[j]] = 1;
      level.tangent.vmult(level.Kd, level.d);
      level.d.entries()[coarsest_entries_[j]] = 0;
      for (std::size_t i = 0; i < n; ++i)
        coarsest_inverse_(i, j) = level.Kd.entries()[coarsest_entries_[i]];
    }
    coarsest_inverse_.symmetrize();
    coarsest_inverse_.gauss_jordan();
  }

  /// Adds to x what lessens r = b - K x.
  /// @param is_last  leaves r as it was before the last step.
  template <class Real>
  void GeometricMultigrid<Real>::smooth(Level &level, const bool is_last) const
  {
    const Real scale = 1 / level.largest_eigenvalue;
    for (unsigned int k = 0; k < level.degree; ++k)
    {
      level.precondition(k == 0 ? 0 : Real(2 * k - 1.) / (2 * k + 3),
                         scale * (8 * k + 4) / (2 * k + 3));
      level.step(is_last && k + 1 == level.degree);
    }
  }

  /// Adds to x of a level what lessens its r.
  template <class Real>
  void GeometricMultigrid<Real>::cycle(const unsigned int l) const
  {
    Level &level = *levels_[l];
    if (l + 1 == levels_.size())
    {
      const std::size_t n = coarsest_entries_.size();
      dealii::Vector<double> b(n), solution(n);
      for (std::size_t i = 0; i < n; ++i)
        b[i] = level.r.entries()[coarsest_entries_[i]];
      coarsest_inverse_.vmult(solution, b);
      for (std::size_t i = 0; i < n; ++i)
        level.x.entries()[coarsest_entries_[i]] = solution[i];
      return;
    }
    Level &coarse = *levels_[l + 1];
    smooth(level, false);
    coarse.unknowns.sum_up(level.r, coarse.r);
    std::fill(coarse.x.entries().begin(), coarse.x.entries().end(), Real(0));
    cycle(l + 1);
    level.unknowns.interpolate(coarse.x, level.d);
    level.step();
    smooth(level, true);
  }

  template <class Real>
  void GeometricMultigrid<Real>::vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
    Level &level = *levels_[0];
    level.unknowns.for_each(level.r, x, [](Real &r_i, const Real x_i) { r_i = x_i; });
    level.unknowns.hold(level.r);
    std::fill(level.x.entries().begin(), level.x.entries().end(), Real(0));
    cycle(0);
    level.unknowns.for_each(y, level.x, [](Real &y_i, const Real x_i) { y_i = x_i; });
  }

  template <class Real>
  void GeometricMultigrid<Real>::set_finest_state(const LatticeVector<Real> &u)
  {
    if (levels_.size() == 1) // its inverse is that of set_state()
      return;
    smoother_ = Tangent::definite;
    levels_[0]->tangent.elasticity().set_state(u, smoother_);
    levels_[0]->tangent.inverse_diagonal(levels_[0]->inverse_diagonal);
  }

  template <class Real>
  std::size_t GeometricMultigrid<Real>::memory() const
  {
    std::size_t bytes = coarsest_inverse_.memory_consumption();
    for (const auto &level : levels_)
      bytes += level->tangent.memory() + level->unknowns.nodes().size() * (18 * sizeof(Real) + 1);
    return bytes;
  }

  template class GeometricMultigrid<double>;
  template class GeometricMultigrid<float>;
} // namespace softcell
