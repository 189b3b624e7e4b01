// SPDX-License-Identifier: LGPL-2.1-or-later
// Steps in time of a single mass, against their own theory and against exact motions.

#include <softcell/base/types.h>
#include <softcell/solvers/time_integration.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

namespace
{
  using namespace softcell;

  struct OneNumber
  {
    std::array<double, 1> x{};

    softcell::View<double> entries()
    {
      return {x.data(), 1};
    }
  };

  /// A mass of 1 kg with the force -r(u) and its stiffness.
  EquationOfMotion<OneNumber> mass_on(const std::function<double(double)> &r,
                                      const std::function<double(double)> &stiffness_at,
                                      double &stiffness_now)
  {
    EquationOfMotion<OneNumber> motion;
    motion.impulse = [=, &stiffness_now](const OneNumber &u, const OneNumber &v, double, double h,
                                         OneNumber &b) {
      stiffness_now = stiffness_at(u.x[0]);
      b.x[0]        = v.x[0] - h * r(u.x[0]);
    };
    motion.solve = [&stiffness_now](double mass, double stiffness, const OneNumber &b,
                                    OneNumber &w) {
      w.x[0] = b.x[0] / (mass + stiffness * stiffness_now);
    };
    return motion;
  }

  constexpr double omega = 3;

  /// v + i omega u of an undamped oscillator after n steps from u = 1, v = 0.5.
  std::complex<double> oscillator(const TimeScheme scheme, const double dt, const unsigned int n)
  {
    double k;
    const auto motion =
      mass_on([](double u) { return omega * omega * u; }, [](double) { return omega * omega; }, k);
    OneNumber u{{1}}, v{{0.5}};
    for (unsigned int i = 0; i < n; ++i)
      advance(motion, scheme, i * dt, dt, u, v);
    return {v.x[0], omega * u.x[0]};
  }

  // (v_1 + i omega u_1)(1 - i omega dt) = v_0 + i omega u_0: it shrinks by 1/sqrt(1 + omega^2
  // dt^2).
  TEST(TimeIntegration, ImplicitEulerHasItsAmplificationFactor)
  {
    for (const double dt : {0.01, 0.3, 5.})
    {
      const std::complex<double> start(0.5, omega),
        factor = 1. / std::complex<double>(1, -omega * dt),
        found  = oscillator(TimeScheme::implicit_euler, dt, 7);
      EXPECT_LT(std::abs(found - start * std::pow(factor, 7)), 1e-13 * std::abs(start));
      EXPECT_NEAR(std::abs(found), std::abs(start) * std::pow(1 + std::pow(omega * dt, 2), -3.5),
                  1e-13 * std::abs(start));
    }
  }

  // With a = omega dt / 2 the factor is (1 + i a) / (1 - i a): the energy stays, and the frequency
  // is atan(a) / a of the true one, which is 1 - (omega dt)^2 / 12 + O(dt^4).
  TEST(TimeIntegration, NewmarkKeepsTheEnergyAndErrsInFrequencyBySecondOrder)
  {
    const std::complex<double> start(0.5, omega);
    for (const double dt : {0.01, 0.3, 5.})
    {
      const std::complex<double> one(1, omega * dt / 2),
        found = oscillator(TimeScheme::newmark, dt, 50);
      EXPECT_NEAR(std::abs(found), std::abs(start), 1e-13 * std::abs(start));
      EXPECT_LT(std::abs(found - start * std::pow(one / std::conj(one), 50)), 1e-12);
    }
    const double dt     = 0.02;
    const double turned = std::arg(oscillator(TimeScheme::newmark, dt, 1) / start);
    EXPECT_NEAR(1 - turned / (omega * dt), std::pow(omega * dt, 2) / 12,
                std::pow(omega * dt, 4) / 80 * 1.01);
  }

  /// |u - exact| at t = 1 of a damped oscillator from u = 1 at rest. Exact is
  /// exp(-z omega t)(cos(w t) + z omega / w sin(w t)), z = a/(2 omega) + b omega/2, w = omega
  /// sqrt(1 - z^2).
  double damped_error(const TimeScheme scheme, const unsigned int n)
  {
    double k;
    auto motion =
      mass_on([](double u) { return omega * omega * u; }, [](double) { return omega * omega; }, k);
    motion.mass_damping      = 0.4;
    motion.stiffness_damping = 0.05;
    OneNumber u{{1}}, v;
    for (unsigned int i = 0; i < n; ++i)
      advance(motion, scheme, i / double(n), 1. / n, u, v);
    const double z = motion.mass_damping / (2 * omega) + motion.stiffness_damping * omega / 2,
                 w = omega * std::sqrt(1 - z * z);
    return std::abs(u.x[0] - std::exp(-z * omega) * (std::cos(w) + z * omega / w * std::sin(w)));
  }

  /// |u - exact| at t = 1 of r = 2 u + 2 u^3: u = tan t solves u'' = 2 u + 2 u^3, so with the other
  /// sign tanh t solves u'' = -2 u + 2 u^3.
  double nonlinear_error(const TimeScheme scheme, const unsigned int n)
  {
    double k;
    const auto motion = mass_on([](double u) { return 2 * u - 2 * u * u * u; },
                                [](double u) { return 2 - 6 * u * u; }, k);
    OneNumber u, v{{1}};
    for (unsigned int i = 0; i < n; ++i)
      advance(motion, scheme, i / double(n), 1. / n, u, v);
    return std::abs(u.x[0] - std::tanh(1.));
  }

  TEST(TimeIntegration, HasItsOrderWithDampingAndWithANonlinearForce)
  {
    for (const auto &error : {damped_error, nonlinear_error})
    {
      // twice and four times as many steps; the next term of the error is O(dt) of it
      EXPECT_NEAR(error(TimeScheme::implicit_euler, 400) / error(TimeScheme::implicit_euler, 800),
                  2, 0.04);
      EXPECT_NEAR(error(TimeScheme::newmark, 400) / error(TimeScheme::newmark, 800), 4, 0.04);
    }
  }
} // namespace
