// SPDX-License-Identifier: LGPL-2.1-or-later
// Steps in time, each by one linear system.
#pragma once

#include <cstddef>
#include <functional>

namespace softcell
{
  enum class TimeScheme
  {
    implicit_euler, // first order, damps what is fast
    newmark         // average acceleration: second order, keeps the energy of a linear law
  };

  /// What a step needs to know of M u'' + C u' + r(u) = f(t), with K = dr/du and C a mixture of M
  /// and K (Rayleigh).
  template <class V>
  struct EquationOfMotion
  {
    /// b = M v + h (f(t) - r(u)), and from now on K is that at u. Units: kg m/s
    std::function<void(const V &u, const V &v, double t, double h, V &b)> impulse;

    /// Solves (mass M + stiffness K) w = b, perhaps not to the end, from the given w on.
    /// @param stiffness  Units: s^2
    std::function<void(double mass, double stiffness, const V &b, V &w)> solve;

    double mass_damping      = 0; // C = mass_damping M + stiffness_damping K. Units: 1/s
    double stiffness_damping = 0; // Units: s
  };

  /// Takes displacement u (m) and velocity v (m/s) from time t to t + dt.
  ///
  /// With h = dt, implicit Euler's end velocity w is that of
  ///   (M + h C + h^2 K) w = M v + h (f(t + h) - r(u)),
  /// the linearised step of Baraff and Witkin (1998; Magnoux, annex B, eq. B.11) written for w
  /// rather than for its change dv = w - v: that takes h^2 K v to the left. Newmark's method with
  /// average acceleration, linearised as well, is the same with h = dt/2 and w as the mean
  /// velocity. In both, w = 0 is where r(u) = f.
  ///
  /// If `solve` gives a w with w (A w - b) = 0 (conjugate gradients from 0 do, after any number of
  /// iterations), then for a linear law and no load the energy cannot rise: implicit Euler takes
  /// 1/2 |w - v|_M^2 + h^2/2 |w|_K^2 + h |w|_C^2 of it, Newmark 2 h |w|_C^2.
  template <class V>
  void
  advance(const EquationOfMotion<V> &motion, TimeScheme scheme, double t, double dt, V &u, V &v)
  {
    const double theta = scheme == TimeScheme::newmark ? 0.5 : 1, h = theta * dt;
    V b(v), w(v);
    motion.impulse(u, v, t + h, h, b);
    motion.solve(1 + h * motion.mass_damping, h * (h + motion.stiffness_damping), b, w);
    const auto w_i = w.entries(), u_i = u.entries(), v_i = v.entries();
    for (std::size_t i = 0; i < w_i.size(); ++i)
    {
      u_i[i] += dt * w_i[i];
      v_i[i] += (w_i[i] - v_i[i]) / theta;
    }
  }
} // namespace softcell
