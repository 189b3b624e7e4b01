// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies that are squeezed flat, torn about and held still.

#include "moving_bodies.h"

#include <softcell/base/exceptions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
  using namespace softcell;

  /// A cube whose points are at `length` times their height at first.
  template <class Real>
  void expect_cube_returns(const double length,
                           const double tolerance,
                           const unsigned int max_iterations)
  {
    SCOPED_TRACE(length);
    const CellLattice cells = cells_of("box", Point(0.1, 0.1, 0.1), 4);
    MotionParameters parameters;
    parameters.mass_damping = 2;
    LatticeMotion<Real> motion(cells, Material("Neo-Hookean", 1000, 0.45, 1000),
                               entries_below(cells, 0.01), {}, parameters);
    fill(cells, motion.displacement(),
         [length](const Point &X) { return Direction(Point(0, 0, (length - 1) * X[2])); });
    const LatticeVector<Real> nothing(cells.nodes);
    double highest     = motion.strain_energy();
    const double start = highest;
    for (unsigned int i = 0; i < 600; ++i)
    {
      motion.advance(1. / 60, nothing, nothing, {tolerance, max_iterations});
      highest = std::max(highest, motion.strain_energy() + motion.kinetic_energy());
    }
    EXPECT_LE(highest, 1.01 * start);
    double farthest = 0;
    for (const Real u : motion.displacement().entries())
      farthest = std::max<double>(farthest, std::abs(u));
    EXPECT_LT(farthest, 1e-4);
    EXPECT_GT(motion.tangent().elasticity().min_jacobian(motion.displacement()), 0.9);
  }

  // From far behind its base it needs steps that are solved well: there are other equilibria beside
  // its symmetric way.
  TEST(RoughMotion, WhatIsSqueezedFlatOrInsideOutReturns)
  {
    expect_cube_returns<float>(0, 1e-3, 10);
    expect_cube_returns<double>(-0.5, 1e-3, 10);
    expect_cube_returns<double>(-0.7, 1e-8, 200);
  }

  /// A cylinder that stands on its base, and the entries of its top.
  struct Grasped
  {
    CellLattice cells                 = cells_of("cylinder", Point(), 5);
    std::vector<std::size_t> tool     = entries_above(cells, 0.19),
                             all_held = entries_below(cells, 0.01);

    Grasped()
    {
      all_held.insert(all_held.end(), tool.begin(), tool.end());
    }

    template <class Real>
    LatticeMotion<Real> motion(const MotionParameters &parameters = {}) const
    {
      return {cells, Material("Neo-Hookean", 5000, 0.45, 1000), all_held, {}, parameters};
    }

    template <class Real>
    LatticeVector<Real> imposed(const Direction &at) const
    {
      LatticeVector<Real> u(cells.nodes);
      for (const std::size_t entry : tool)
        u.entries()[entry] = at[entry / cells.nodes.size()];
      return u;
    }
  };

  // Before its first iteration a step is a combination of the last velocity and its change, of
  // which light nodes know the former alone.
  TEST(RoughMotion, LightNodesAreNotExtrapolated)
  {
    const CellLattice cells = cells_of("sphere", Point(), 6);
    LatticeMotion<double> motion(cells, soft_tissue, {}, {}, {});
    const LatticeVector<double> nothing(cells.nodes);
    const auto step_from = [&](const double frequency) {
      fill(cells, motion.velocity(), [&](const Point &X) {
        return Direction(Point(std::sin(frequency * X[1]), std::cos(frequency * X[2]), 1));
      });
      const LatticeVector<double> v = motion.velocity();
      motion.advance(1e-3, nothing, nothing, {1e-6, 0});
      return v;
    };
    step_from(20);
    const LatticeVector<double> v = step_from(60);
    const double *const m         = motion.tangent().masses().component(0);
    const double most             = *std::max_element(m, m + cells.nodes.size());
    std::vector<double> light, heavy; // ratios
    for (const std::size_t node : cells.entries)
      (m[node] < 0.01 * most ? light : heavy)
        .push_back(motion.velocity().component(0)[node] / v.component(0)[node]);
    ASSERT_GT(light.size(), 4);
    const auto spread = [](const std::vector<double> &ratios) {
      const auto [least, largest] = std::minmax_element(ratios.begin(), ratios.end());
      return *largest - *least;
    };
    EXPECT_LT(spread(light), 1e-10);
    EXPECT_GT(spread(heavy), 1e-3);
  }

  // A leap that would put in more energy than its step foresees is followed late, as a whole.
  TEST(RoughMotion, WhatALeapImposesComesLate)
  {
    const Grasped body;
    auto motion = body.motion<float>();
    const LatticeVector<float> nothing(body.cells.nodes);
    const Direction there(Point(0.05, 0, 0.03));
    const std::size_t entry = body.tool.front();
    const auto &u           = std::as_const(motion).displacement();
    motion.advance(1. / 60, nothing, body.imposed<float>(there), {1e-6, 4});
    const double before = u.entries()[entry];
    motion.advance(1. / 60, nothing, body.imposed<float>(-there), {1e-6, 4});
    const double halvings = -std::log2((u.entries()[entry] - before) / (-there[0] - before));
    EXPECT_GE(halvings, 0.999);
    EXPECT_NEAR(halvings, std::round(halvings), 1e-5);
    for (unsigned int frame = 0; frame < 120; ++frame)
      motion.advance(1. / 60, nothing, body.imposed<float>(-there), {1e-6, 4});
    EXPECT_NEAR(u.entries()[entry], -there[0], 1e-6);
    EXPECT_GT(motion.tangent().elasticity().min_jacobian(u), 0.2);
  }

  // From rest the linear system's force is in proportion to its way.
  TEST(RoughMotion, AShortenedStepHasTheForceOfItsWay)
  {
    const Grasped body;
    const LatticeVector<double> nothing(body.cells.nodes);
    for (const auto &[scheme, height] :
         {std::pair(TimeScheme::implicit_euler, -0.19), std::pair(TimeScheme::newmark, -0.06)})
    {
      const Direction leap(Point(0, 0, height));
      const MotionParameters parameters{scheme, 2, 0.01};
      auto motion = body.motion<double>(parameters), shorter = body.motion<double>(parameters);
      const double way =
        motion.advance(1. / 60, nothing, body.imposed<double>(leap), {1e-12, 1000}).way;
      ASSERT_LT(way, 1);
      ASSERT_EQ(
        shorter.advance(1. / 60, nothing, body.imposed<double>(way * leap), {1e-12, 1000}).way, 1);
      double largest = 0;
      for (const std::size_t entry : body.all_held)
        largest = std::max(largest, std::abs(shorter.reaction().entries()[entry]));
      for (const std::size_t entry : body.all_held)
        ASSERT_NEAR(motion.reaction().entries()[entry], shorter.reaction().entries()[entry],
                    1e-9 * largest);
    }
  }

  // But for the 5 % that it may, by the force that it tells.
  TEST(RoughMotion, NoStepGainsEnergyThatNothingPutsIn)
  {
    const Grasped body;
    auto motion = body.motion<double>();
    const LatticeVector<double> nothing(body.cells.nodes),
      imposed     = body.imposed<double>(Direction(Point(0, 0, -0.3)));
    const auto &u = std::as_const(motion).displacement();
    bool is_late  = false;
    for (unsigned int frame = 0; frame < 10; ++frame)
    {
      const LatticeVector<double> before = u;
      for (const std::size_t entry : body.all_held)
        motion.velocity().entries()[entry] = 60 * (imposed.entries()[entry] - u.entries()[entry]);
      double energy = motion.kinetic_energy() + motion.strain_energy();
      is_late |= motion.advance(1. / 60, nothing, imposed, {1e-6, 1000}).way < 1;
      for (const std::size_t entry : body.all_held)
        energy +=
          motion.reaction().entries()[entry] * (u.entries()[entry] - before.entries()[entry]);
      ASSERT_LE(0.95 * (motion.kinetic_energy() + motion.strain_energy()), energy * (1 + 1e-9))
        << frame;
    }
    EXPECT_TRUE(is_late);
  }

  // But for the 5 % that all steps together may. Squeezed, the exact tangent is indefinite: without
  // the definite one there are steps that solve nothing.
  TEST(RoughMotion, NewmarkGainsNoEnergyUnderCompression)
  {
    const Grasped body;
    auto motion = body.motion<double>({TimeScheme::newmark});
    const LatticeVector<double> nothing(body.cells.nodes);
    const auto &u     = std::as_const(motion).displacement();
    const auto energy = [&] { return motion.kinetic_energy() + motion.strain_energy(); };
    double before = 0, put_in = 0, most = 0;
    for (unsigned int frame = 1; frame <= 90; ++frame)
    {
      const double depth                   = std::min(0.4 * frame / 60, 0.12);
      const auto imposed                   = body.imposed<double>(Direction(Point(0, 0, -depth)));
      const LatticeVector<double> u_before = u;
      for (const std::size_t entry : body.all_held)
        motion.velocity().entries()[entry] = 60 * (imposed.entries()[entry] - u.entries()[entry]);
      put_in += energy() - before;
      ASSERT_LE(motion.advance(1. / 60, nothing, imposed, {1e-3, 1000}).residual, 1e-3) << frame;
      for (const std::size_t entry : body.all_held)
        put_in +=
          motion.reaction().entries()[entry] * (u.entries()[entry] - u_before.entries()[entry]);
      most   = std::max(most, put_in);
      before = energy();
      ASSERT_LE(0.95 * before, most * (1 + 1e-9)) << frame;
    }
  }

  TEST(RoughMotion, WhatIsNotFiniteIsRefused)
  {
    const Grasped body;
    const std::size_t inner = body.cells.entries[body.cells.entries.size() / 2];
    const LatticeVector<float> nothing(body.cells.nodes);
    for (const TimeScheme scheme : {TimeScheme::newmark, TimeScheme::implicit_euler})
      for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), 1e38F})
      {
        auto motion   = body.motion<float>({scheme});
        const auto &u = std::as_const(motion).displacement();
        motion.advance(1. / 60, nothing, body.imposed<float>(Direction(Point(0.01, 0, 0))),
                       {1e-3, 4});
        const LatticeVector<float> before = u;
        LatticeVector<float> force        = nothing;
        force.entries()[inner]            = wrong;
        EXPECT_THROW(motion.advance(1. / 60, force, nothing, {1e-3, 4}), NotConverged);
        EXPECT_TRUE(std::equal(u.entries().begin(), u.entries().end(), before.entries().begin()));
      }
  }

  // A tool that leaps by half the body's length from frame to frame, for two iterations each.
  TEST(RoughMotion, RoughHandlingIsNoBlowUp)
  {
    const CellLattice cells             = cells_of("cylinder", Point(), 4);
    const std::vector<std::size_t> tool = entries_above(cells, 0.19);
    std::vector<std::size_t> held       = entries_below(cells, 0.01);
    held.insert(held.end(), tool.begin(), tool.end());
    MotionParameters parameters;
    parameters.mass_damping = 2;
    LatticeMotion<float> motion(cells, Material("Neo-Hookean", 1000, 0.45, 1000), held, {},
                                parameters);
    const LatticeVector<float> nothing(cells.nodes);
    LatticeVector<float> imposed = nothing;
    for (unsigned int frame = 0; frame < 60; ++frame)
    {
      for (const std::size_t entry : tool)
        imposed.entries()[entry] = 0.05F * std::sin(2.F * frame + entry / cells.nodes.size());
      motion.advance(1. / 60, nothing, imposed, {1e-3, 2});
      ASSERT_TRUE(std::isfinite(motion.kinetic_energy() + motion.strain_energy()));
    }
    for (unsigned int frame = 0; frame < 600; ++frame)
      motion.advance(1. / 60, nothing, nothing, {1e-3, 10});
    for (const float u : motion.displacement().entries())
      ASSERT_LT(std::abs(u), 1e-4);
  }

  // Held still for long under its weight, a column is in equilibrium: the base carries all of it.
  TEST(RoughMotion, HeldStillTheReactionIsTheStaticOne)
  {
    const CellLattice cells = cells_of("cylinder", Point(), 4);
    const auto base         = entries_below(cells, 0.01);
    MotionParameters parameters;
    parameters.mass_damping = 20;
    LatticeMotion<double> motion(cells, Material("Neo-Hookean", 20000, 0.3, 1000), base, {},
                                 parameters);
    const LatticeVector<double> force = weight(cells, motion), nothing(cells.nodes);
    double total                      = 0;
    for (const double f : force.entries())
      total += f;
    for (unsigned int i = 0; i < 200; ++i)
      motion.advance(0.05, force, nothing, {1e-8, 1000});
    Direction sum;
    for (const std::size_t entry : base)
      sum[entry / cells.nodes.size()] += motion.reaction().entries()[entry];
    EXPECT_NEAR(sum[2], -total, 1e-6 * std::abs(total));
    EXPECT_LT(std::abs(sum[0]) + std::abs(sum[1]), 1e-6 * std::abs(total));
  }
} // namespace
