// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies in motion: what theory says of mass, free fall, waves, energy and momentum.

#include "moving_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace
{
  using namespace softcell;

  TEST(LatticeMotion, MassIsDensityTimesVolumeWithItsCentre)
  {
    const CellLattice cells = cells_of("box", Point(0.3, 0.2, 0.1), 4);
    const auto masses       = lumped<double>(1000, cells);
    double mass             = 0;
    Direction moment;
    for (const std::size_t node : cells.entries)
    {
      mass += masses.component(0)[node];
      moment += masses.component(0)[node] * Direction(position(cells, node));
    }
    EXPECT_NEAR(mass, 6, 1e-13);
    EXPECT_LT((moment - 6 * Direction(Point(0.15, 0.1, 0.05))).norm(), 1e-13);
  }

  // v_n = -g n dt; u_n = -g (n dt)^2 / 2, by implicit Euler -g dt^2 n (n + 1) / 2.
  TEST(LatticeMotion, FallsFreely)
  {
    const CellLattice cells = cells_of("cylinder", Point(), 3);
    for (const TimeScheme scheme : {TimeScheme::newmark, TimeScheme::implicit_euler})
    {
      LatticeMotion<double> motion(cells, soft_tissue, {}, {}, {scheme});
      const double dt  = 0.1;
      const unsigned n = 5;
      for (unsigned int i = 0; i < n; ++i)
        motion.advance(dt, weight(cells, motion), LatticeVector<double>(cells.nodes), exactly);
      const double fall =
        9.81 * dt * dt / 2 * (scheme == TimeScheme::newmark ? n * n : n * (n + 1));
      for (const std::size_t node : cells.entries)
      {
        ASSERT_NEAR(motion.displacement().component(2)[node], -fall, 1e-9 * fall);
        ASSERT_NEAR(motion.displacement().component(0)[node], 0, 1e-9 * fall);
      }
    }
  }

  // A bar without lateral contraction, clamped at z = 0: linear elements with lumped masses have
  // the mode sin(j pi / 2n) of frequency 2 c/h sin(pi / 4n).
  TEST(LatticeMotion, ABarSwingsInItsLowestMode)
  {
    const CellLattice cells = cells_of("box", Point(0.1, 0.1, 1), 2);
    const int n             = cells.nodes.n_cells()[2];
    const double c = 2, h = 1. / n, dt = 0.05, omega_h = 2 * c / h * std::sin(M_PI / (4 * n));
    for (const TimeScheme scheme : {TimeScheme::newmark, TimeScheme::implicit_euler})
    {
      LatticeMotion<double> motion(cells, Material("linear", 4000, 0, 1000),
                                   entries_below(cells, 0.5 * h), {}, {scheme});
      const auto mode = [](const Point &X) {
        return Direction(Point(0, 0, 0.01 * std::sin(M_PI / 2 * X[2])));
      };
      fill(cells, motion.displacement(), mode);
      const LatticeVector<double> nothing(cells.nodes);
      for (unsigned int i = 0; i < 20; ++i)
        motion.advance(dt, nothing, nothing, exactly);
      const std::complex<double> i_a(0, omega_h * dt / 2);
      const auto factor =
        scheme == TimeScheme::newmark ? (1. + i_a) / (1. - i_a) : 1. / (1. - 2. * i_a);
      const double amplitude =
        (std::complex<double>(0, omega_h) * std::pow(factor, 20)).imag() / omega_h;
      for (const std::size_t node : cells.entries)
        ASSERT_NEAR(motion.displacement().component(2)[node],
                    amplitude * mode(position(cells, node))[2], 1e-9 * 0.01);
    }
  }

  // Whatever the number of iterations, see advance().
  TEST(LatticeMotion, FewIterationsNeverRaiseTheEnergyOfALinearLaw)
  {
    const CellLattice cells = cells_of("cylinder", Point(), 4);
    for (const TimeScheme scheme : {TimeScheme::newmark, TimeScheme::implicit_euler})
      for (const unsigned int n_iterations : {0, 1, 3, 1000})
      {
        LatticeMotion<double> motion(cells, Material("linear", 1000, 0.3, 1000),
                                     entries_below(cells, 0.01), {}, {scheme});
        fill(cells, motion.displacement(), [](const Point &X) {
          return 0.1 * X[2] * Direction(Point(std::sin(30 * X[2]), 0.2, X[0]));
        });
        const LatticeVector<double> nothing(cells.nodes);
        const double start = motion.strain_energy();
        double before      = start;
        for (unsigned int i = 0; i < 30; ++i)
        {
          motion.advance(1. / 60, nothing, nothing, {1e-13, n_iterations});
          const double energy = motion.strain_energy() + motion.kinetic_energy();
          if (scheme == TimeScheme::newmark)
            ASSERT_NEAR(energy, start, 1e-11 * start) << n_iterations << ' ' << i;
          else
            ASSERT_LE(energy, before * (1 + 1e-12)) << n_iterations << ' ' << i;
          before = energy;
        }
      }
  }

  struct Momentum
  {
    Direction linear, angular;
  };

  Momentum momentum(const CellLattice &cells, LatticeMotion<double> &motion)
  {
    Momentum sum;
    for (const std::size_t node : cells.entries)
    {
      Direction x = position(cells, node), v;
      for (unsigned int c = 0; c < dim; ++c)
      {
        x[c] += motion.displacement().component(c)[node];
        v[c] = motion.tangent().masses().component(0)[node] * motion.velocity().component(c)[node];
      }
      sum.linear += v;
      sum.angular += cross_product_3d(x, v);
    }
    return sum;
  }

  // A free body that spins and swings. Angular momentum errs by the order of the scheme.
  TEST(LatticeMotion, MomentumOfAFreeBodyStays)
  {
    const CellLattice cells = cells_of("cylinder", Point(), 3);
    const auto loss         = [&](const TimeScheme scheme, const unsigned int n) {
      LatticeMotion<double> motion(cells, soft_tissue, {}, {}, {scheme});
      fill(cells, motion.velocity(), [](const Point &X) {
        return Direction(Point(0.3 - 4 * X[1], 0.1 + 4 * X[0] - X[2], 2 * (X[2] - 0.1) + 0.2));
      });
      const Momentum before = momentum(cells, motion);
      const LatticeVector<double> nothing(cells.nodes);
      for (unsigned int i = 0; i < n; ++i)
        motion.advance(0.05 / n, nothing, nothing, exactly);
      const Momentum after = momentum(cells, motion);
      EXPECT_LT((after.linear - before.linear).norm(), 1e-10 * before.linear.norm());
      return (after.angular - before.angular).norm() / before.angular.norm();
    };
    const double euler   = loss(TimeScheme::implicit_euler, 80),
                 newmark = loss(TimeScheme::newmark, 80);
    EXPECT_NEAR(euler / loss(TimeScheme::implicit_euler, 160), 2, 0.2);
    EXPECT_NEAR(newmark / loss(TimeScheme::newmark, 160), 4, 0.4);
    EXPECT_LT(newmark, euler);
  }
} // namespace
