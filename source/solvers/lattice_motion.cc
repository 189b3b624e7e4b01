// SPDX-License-Identifier: LGPL-2.1-or-later
// A body on a uniform grid in motion: its steps' linear systems.

#include <softcell/solvers/lattice_motion.h>

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace softcell
{
  namespace
  {
    void throw_unless_finite(const double number)
    {
      if (!std::isfinite(number))
        throw NotConverged("a step in time met displacements, velocities or forces that are not "
                           "finite numbers");
    }
  } // namespace

  template <class Real>
  LatticeMotion<Real>::LatticeMotion(const CellLattice &cells,
                                     const Material &material,
                                     const std::vector<std::size_t> &held,
                                     LatticeMatrix<Real> supports,
                                     const MotionParameters &parameters)
      : parameters_(parameters),
        held_(held),
        unknowns_(cells, held),
        tangent_(cells, material.invertible(), unknowns_),
        u_(cells.nodes),
        v_(cells.nodes),
        reaction_(cells.nodes),
        r_(cells.nodes),
        z_(cells.nodes),
        p_(cells.nodes),
        Ap_(cells.nodes),
        start_(cells.nodes),
        way_(cells.nodes),
        w_before_(cells.nodes),
        starts_(2, u_),
        A_starts_(2, u_),
        multigrid_(cells, material.invertible(), held, 1)
  {
    constexpr double light = 0.01; // of the largest mass; see prepare_starts()
    tangent_.supports()    = std::move(supports);
    const Real *const m    = tangent_.masses().component(0);
    const std::size_t n    = cells.nodes.size();
    const double most      = *std::max_element(m, m + n);
    for (std::size_t entry = 0; entry < 3 * n; ++entry)
      if (const Real mass = m[entry % n]; mass > 0 && mass < light * most)
        light_.push_back(entry);
  }

  template <class Real>
  double LatticeMotion<Real>::kinetic_energy() const
  {
    return 0.5 * unknowns_.dot(v_, v_, tangent_.masses());
  }

  template <class Real>
  typename LatticeMotion<Real>::Step
  LatticeMotion<Real>::advance(const double dt,
                               const LatticeVector<Real> &external,
                               const LatticeVector<Real> &imposed,
                               const Effort &effort)
  {
    double h    = dt;
    auto solved = Clock::now();
    EquationOfMotion<LatticeVector<Real>> motion;
    motion.mass_damping      = parameters_.mass_damping;
    motion.stiffness_damping = parameters_.stiffness_damping;
    motion.impulse = [&](const auto &, const auto &, const double, const double step, auto &b) {
      h = step;
      impulse(external, h, b);
    };
    motion.solve = [&](const double mass, const double stiffness, const auto &b, auto &w) {
      combine(Real(stiffness), Real(mass), effort.deadline == Clock::time_point::max());
      solve(effort, b, w);
      solved = Clock::now();
    };
    for (const std::size_t entry : held_) // as fast as they have to be
      v_.entries()[entry] = (imposed.entries()[entry] - u_.entries()[entry]) / Real(dt);
    const double before = kinetic_energy() + strain();
    throw_unless_finite(before);
    start_ = u_;
    softcell::advance(motion, parameters_.scheme, 0, dt, u_, v_);
    way_ = u_;
    add(way_, -1, start_);
    unknowns_.for_each(reaction_, r_,
                       [factor = Real(-1 / h)](Real &R_i, const Real r_i) { R_i = factor * r_i; });
    shorten(external, before, dt, h);
    after_solve_ = Clock::now() - solved;
    return step_;
  }

  template <class Real>
  double LatticeMotion<Real>::strain()
  {
    if (!has_strain_)
      try
      {
        strain_ = strain_energy();
      }
      catch (const InvertedPoint &) // an invertible law's value is beyond all numbers
      {
        strain_ = std::numeric_limits<double>::infinity();
      }
    has_strain_ = true;
    return strain_;
  }

  /// What supports, loads and held entries did on the way. Units: J
  template <class Real>
  double LatticeMotion<Real>::work(const LatticeVector<Real> &external)
  {
    std::fill(z_.entries().begin(), z_.entries().end(), Real(0));
    tangent_.supports().add_product(z_, u_);
    double sum = unknowns_.dot(external, way_) - unknowns_.dot(z_, way_);
    for (const std::size_t entry : held_)
      sum += double(reaction_.entries()[entry]) * way_.entries()[entry];
    return sum;
  }

  /// Halves the way, also that of held entries, until there is hardly more energy than there was
  /// and than was put in. The energy of a law that stiffens may rise above that of its
  /// linearisation. What steps gained is added up, less what others lost, but for losses before
  /// the first gain: a margin of each step's own would let the energy grow without end.
  template <class Real>
  void LatticeMotion<Real>::shorten(const LatticeVector<Real> &external,
                                    const double before,
                                    const double dt,
                                    const double h)
  {
    constexpr unsigned int most = 10; // halvings, then the body stops where it was
    constexpr double margin     = 0.05;
    for (unsigned int n = 0;; ++n)
    {
      has_strain_          = false;
      const double energy  = strain() + kinetic_energy(),
                   allowed = before + work(external) - gained_;
      if (!std::isfinite(energy + allowed))
        u_ = start_;
      throw_unless_finite(energy + allowed);
      if ((1 - margin) * energy <= allowed || n > most)
      {
        // no more than lets a body that stays where it is move again
        gained_ = std::min(std::max(energy - allowed, 0.), margin * energy);
        return;
      }
      const Real kept = n < most ? 0.5 : 0;
      take_back((1 - kept) / (dt * h));
      unknowns_.for_each(way_, way_, [kept](Real &way_i, Real) { way_i *= kept; });
      u_ = start_;
      add(u_, 1, way_);
      unknowns_.for_each(v_, way_, [dt](Real &v_i, const Real way_i) { v_i = way_i / Real(dt); });
      step_.way *= kept;
      if (kept == 0)
        step_.residual = 1; // as nothing was done of what was asked for
    }
  }

  /// Takes from the reaction what the linear system has for a multiple of the way, but for inertia.
  /// Units: 1/s^2
  template <class Real>
  void LatticeMotion<Real>::take_back(const double multiple)
  {
    tangent_.product(Ap_, way_);
    const Real *const m = tangent_.masses().component(0);
    const std::size_t n = u_.lattice().size();
    for (const std::size_t entry : held_)
      reaction_.entries()[entry] -=
        Real(multiple) * (Ap_.entries()[entry] - m[entry % n] * way_.entries()[entry]);
  }

  template <class Real>
  void LatticeMotion<Real>::linearise()
  {
    const bool is_euler = parameters_.scheme == TimeScheme::implicit_euler;
    tangent_.elasticity().set_state(u_, is_euler ? Tangent::definite : Tangent::exact);
  }

  template <class Real>
  void LatticeMotion<Real>::impulse(const LatticeVector<Real> &external,
                                    const double h,
                                    LatticeVector<Real> &b)
  {
    linearise();
    tangent_.elasticity().residual(u_, r_);
    tangent_.supports().add_product(r_, u_);
    unknowns_.for_each_run([&](const std::size_t begin, const std::size_t end) {
      for (unsigned int c = 0; c < dim; ++c)
      {
        const Real *const m = tangent_.masses().component(0), *const v = v_.component(c),
                          *const r = r_.component(c), *const f = external.component(c);
        Real *const b_c = b.component(c);
        for (std::size_t i = begin; i < end; ++i)
          b_c[i] = m[i] * v[i] + Real(h) * (f[i] - r[i]);
      }
    });
  }

  /// Takes stiffness K + mass M as the matrix A, and multigrid for it: at rest at first. Where an
  /// eigenvalue of multigrid times A is above 2, a V-cycle makes errors larger: where the last step
  /// met one, cells are stiffer than multigrid knows, as squeezed ones are, and the finest grid
  /// takes the displacement. All grids take it where the V-cycle was indefinite, or where there is
  /// time and the last step took long.
  template <class Real>
  void LatticeMotion<Real>::combine(const Real stiffness, const Real mass, const bool has_time)
  {
    constexpr unsigned int many = 20; // iterations
    const bool is_new           = stiffness != stiffness_ || mass != mass_;
    if (!is_new && !(has_time && step_.iterations > many) && std::isfinite(largest_))
    {
      if (largest_ > 2)
        multigrid_.set_finest_state(u_);
      return;
    }
    stiffness_ = stiffness;
    mass_      = mass;
    tangent_.combine(stiffness, mass);
    multigrid_.combine(stiffness, mass);
    const LatticeVector<Real> rest(u_.lattice());
    try
    {
      multigrid_.set_state(is_new ? rest : u_, tangent_.supports());
    }
    catch (const std::runtime_error &) // there a point is inverted or a tangent is not definite
    {
      multigrid_.set_state(rest, tangent_.supports());
    }
  }

  /// y += a x
  template <class Real>
  void
  LatticeMotion<Real>::add(LatticeVector<Real> &y, const Real a, const LatticeVector<Real> &x) const
  {
    unknowns_.for_each(y, x, [a](Real &y_i, const Real x_i) { y_i += a * x_i; });
  }

  /// Takes a direction's part that is A-orthogonal to the starts as one more of them.
  template <class Real>
  void LatticeMotion<Real>::add_start(const LatticeVector<Real> &direction)
  {
    LatticeVector<Real> &d = starts_[n_starts_], &Ad = A_starts_[n_starts_];
    d                 = direction;
    double taken_away = 0;
    for (unsigned int k = 0; k < n_starts_; ++k)
    {
      const double share = unknowns_.dot(A_starts_[k], direction);
      add(d, -Real(share), starts_[k]);
      taken_away += share * share;
    }
    tangent_.product(Ad, d); // also in held entries
    const double left  = unknowns_.dot(d, Ad);
    const double noise = 10 * std::sqrt(std::numeric_limits<Real>::epsilon());
    if (!(left > noise * taken_away && left > 0))
      return;
    const Real scale = 1 / std::sqrt(left);
    for (LatticeVector<Real> *const x : {&d, &Ad})
      unknowns_.for_each(*x, *x, [scale](Real &x_i, const Real) { x_i *= scale; });
    ++n_starts_;
  }

  /// The last velocity w, into p, and its change since the step before. Light nodes have no share
  /// in this: what is wrong there weighs so little that few iterations leave it, and extrapolated
  /// it would grow from step to step.
  template <class Real>
  void LatticeMotion<Real>::prepare_starts(const LatticeVector<Real> &w)
  {
    n_starts_ = 0;
    p_        = w;
    unknowns_.hold(p_);
    z_ = p_;
    add(z_, -1, w_before_);
    for (const std::size_t entry : light_)
      z_.entries()[entry] = 0;
    add_start(p_);
    add_start(z_);
  }

  /// z = nearly A^-1 r, and their product.
  template <class Real>
  double LatticeMotion<Real>::precondition()
  {
    multigrid_.vmult(z_, r_);
    return unknowns_.dot(z_, r_);
  }

  /// Solves A w = b from w = v on and leaves in r what is missing, also in held entries.
  template <class Real>
  void LatticeMotion<Real>::solve(const Effort &effort,
                                  const LatticeVector<Real> &b,
                                  LatticeVector<Real> &w)
  {
    step_ = Step();
    if (!attempt(effort, b, w) && parameters_.scheme == TimeScheme::newmark)
    {
      tangent_.elasticity().set_tangent(Tangent::definite);
      w = v_;
      attempt(effort, b, w);
    }
    throw_unless_finite(unknowns_.dot(w, w));
    w_before_ = v_;
    unknowns_.hold(w_before_);
  }

  /// @return whether the tangent is positive definite, for all that is known.
  template <class Real>
  bool LatticeMotion<Real>::attempt(const Effort &effort,
                                    const LatticeVector<Real> &b,
                                    LatticeVector<Real> &w)
  {
    r_ = b;
    prepare_starts(w);
    add(w, -1, p_); // now what is imposed
    if (std::any_of(held_.begin(), held_.end(),
                    [&](const std::size_t entry) { return w.entries()[entry] != 0; }))
    {
      tangent_.product(Ap_, w);
      add(r_, -1, Ap_);
    }
    double energy = 0; // of what was found, |w|_A^2 less that of what is imposed
    for (unsigned int k = 0; k < n_starts_; ++k)
    {
      const Real share = unknowns_.dot(starts_[k], r_);
      energy += share * share;
      add(w, share, starts_[k]);
      add(r_, -share, A_starts_[k]);
    }
    return iterate(effort, energy, w);
  }

  /// @return whether no negative curvature was met.
  template <class Real>
  bool LatticeMotion<Real>::iterate(const Effort &effort, double energy, LatticeVector<Real> &w)
  {
    // beyond what the precision gives, conjugate gradients go astray
    const double tolerance =
      std::max<double>(effort.tolerance, 10 * std::numeric_limits<Real>::epsilon());
    double rz_before = 1, length_before = 1;
    largest_           = 0;
    auto begin         = Clock::now(); // of this iteration
    const auto is_time = [&] {
      const auto before = begin; // of the last one
      begin             = Clock::now();
      return effort.deadline - after_solve_ - begin > begin - before;
    };
    for (unsigned int n = 0; n < effort.max_iterations && (n == 0 || is_time()); ++n)
    {
      const double rz = precondition();
      throw_unless_finite(rz);
      step_.residual = rz > 0 ? std::sqrt(rz / (energy + rz)) : is_solved() ? 0 : 1;
      if (step_.residual <= tolerance)
        return true;
      if (rz <= 0) // then the preconditioner is not definite
      {
        largest_ = std::numeric_limits<double>::infinity();
        return true;
      }
      const Real share = n > 0 ? rz / rz_before : 0.;
      unknowns_.for_each(p_, z_, [share](Real &p_i, const Real z_i) { p_i = share * p_i + z_i; });
      for (unsigned int k = 0; k < n_starts_; ++k)
        add(p_, -Real(unknowns_.dot(A_starts_[k], z_)), starts_[k]);
      tangent_.product(Ap_, p_);
      const double curvature = unknowns_.dot(p_, Ap_);
      throw_unless_finite(curvature);
      if (curvature <= 0)
        return false;
      // the diagonal of Lanczos' matrix
      largest_          = std::max(largest_, curvature / rz + share / length_before);
      const Real length = rz / curvature;
      length_before     = length;
      add(w, length, p_);
      add(r_, -length, Ap_);
      energy += rz * length;
      rz_before = rz;
      ++step_.iterations;
    }
    return true;
  }

  /// Whether nothing is left in free unknowns.
  template <class Real>
  bool LatticeMotion<Real>::is_solved()
  {
    z_ = r_;
    unknowns_.hold(z_);
    return unknowns_.dot(z_, z_) == 0;
  }

  template class LatticeMotion<double>;
  template class LatticeMotion<float>;
} // namespace softcell
