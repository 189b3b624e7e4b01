// SPDX-License-Identifier: LGPL-2.1-or-later
// A body on a uniform grid in motion, without a matrix and in limited time.
#pragma once

#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/time_integration.h>

#include <chrono>
#include <limits>
#include <vector>

namespace softcell
{
  /// How a body moves, beside its material.
  struct MotionParameters
  {
    TimeScheme scheme        = TimeScheme::implicit_euler;
    double mass_damping      = 0; // 1/s
    double stiffness_damping = 0; // s
  };

  /// Displacement and velocity of a body, and their steps in time.
  ///
  /// Steps solve by conjugate gradients with multigrid, at first for the body at rest, which
  /// stop where they are when time is over. They begin with the best combination of the last
  /// velocity and its last change, which often is within some percent of the solution, and keep
  /// conjugate to both what follows, so that after any number of iterations w (A w - b) = 0 but for
  /// what is imposed, see advance(): few iterations cannot raise the energy. Where the law's own
  /// energy rises above what is put in, the way of the step is halved, up to ten times, or not gone
  /// at all, and what is imposed comes late. All steps together gain no more than a twentieth of
  /// the energy in this way. Implicit Euler uses Tangent::definite, it is of first order with any;
  /// Newmark's method uses it in steps in which conjugate gradients meet negative curvature of the
  /// exact tangent.
  template <class Real>
  class LatticeMotion
  {
  public:
    using Clock = std::chrono::steady_clock;

    /// When a step's linear system may be left.
    struct Effort
    {
      double tolerance            = 1e-2; // of the residual, see Step
      unsigned int max_iterations = 1000;
      Clock::time_point deadline  = Clock::time_point::max(); // of the step, if what follows the
                                                              // system takes as long as last time
    };

    struct Step
    {
      unsigned int iterations = 0; // with those that met negative curvature
      double residual         = 1; // about what w misses in the energy norm, relative; before the
                                   // last iteration, if the end was not the tolerance; 1 where
                                   // nothing of the way was gone
      double way = 1; // the part of it that was gone; what is imposed comes late below 1
    };

    /// At rest.
    /// @param material  with the density
    /// @param held      entries of a LatticeVector whose displacement is imposed.
    /// @param supports  their tangent, which must not change. Units: N/m
    LatticeMotion(const CellLattice &cells,
                  const Material &material,
                  const std::vector<std::size_t> &held,
                  LatticeMatrix<Real> supports,
                  const MotionParameters &parameters);

    /// @param external  the force at u = 0, at the end of the step or, with Newmark, in its middle.
    ///                  Units: N
    /// @param imposed   where the held entries are at the end of the step. Units: m
    /// @throws NotConverged if a number is not finite. The displacement is what it was before; no
    ///                      other step can follow.
    Step advance(double dt,
                 const LatticeVector<Real> &external,
                 const LatticeVector<Real> &imposed,
                 const Effort &effort);

    LatticeVector<Real> &displacement()
    {
      has_strain_ = false;
      gained_     = 0;
      return u_;
    }
    const LatticeVector<Real> &displacement() const
    {
      return u_;
    }
    LatticeVector<Real> &velocity()
    {
      return v_;
    }
    /// The force that held the held entries in the last step, as far as it went, by its linear
    /// system and without these nodes' own inertia. Elsewhere it is what the linear system is in
    /// error. Units: N
    const LatticeVector<Real> &reaction() const
    {
      return reaction_;
    }
    /// Units: J
    double kinetic_energy() const;
    /// Units: J
    double strain_energy() const
    {
      return tangent_.elasticity().energy(u_);
    }
    const LatticeTangent<Real> &tangent() const
    {
      return tangent_;
    }

  private:
    void linearise();
    void impulse(const LatticeVector<Real> &external, double h, LatticeVector<Real> &b);
    void combine(Real stiffness, Real mass, bool has_time);
    double strain();
    double work(const LatticeVector<Real> &external);
    void shorten(const LatticeVector<Real> &external, double before, double dt, double h);
    void take_back(double multiple);
    void add(LatticeVector<Real> &y, Real a, const LatticeVector<Real> &x) const;
    void add_start(const LatticeVector<Real> &direction);
    void prepare_starts(const LatticeVector<Real> &w);
    double precondition();
    void solve(const Effort &effort, const LatticeVector<Real> &b, LatticeVector<Real> &w);
    bool attempt(const Effort &effort, const LatticeVector<Real> &b, LatticeVector<Real> &w);
    bool iterate(const Effort &effort, double energy, LatticeVector<Real> &w);
    bool is_solved();

    MotionParameters parameters_;
    std::vector<std::size_t> held_, light_; // entries, the latter of nodes with little mass
    LatticeUnknowns unknowns_;
    LatticeTangent<Real> tangent_;
    LatticeVector<Real> u_, v_, reaction_;
    LatticeVector<Real> r_, z_, p_, Ap_, start_, way_, w_before_;
    std::vector<LatticeVector<Real>> starts_, A_starts_;
    unsigned int n_starts_ = 0; // that there are
    Real stiffness_ = 0, mass_ = 0;
    GeometricMultigrid<Real> multigrid_;
    Step step_;
    Clock::duration after_solve_{}; // in the last step
    bool has_strain_ = false;
    double strain_   = 0; // energy, if it is known
    double largest_  = 0; // eigenvalue of multigrid times A, as far as the last step tells
    double gained_   = 0; // energy that nothing put in, see shorten()
  };
} // namespace softcell
