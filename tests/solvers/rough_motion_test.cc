// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies that are squeezed flat, torn about and held still.

#include "moving_bodies.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  // Squeezed flat, and turned inside out through its clamped base.
  TEST(RoughMotion, WhatIsSqueezedFlatOrInsideOutReturns)
  {
    const CellLattice cells = cells_of("box", Point(0.1, 0.1, 0.1), 4);
    for (const double length : {0., -0.7})
    {
      MotionParameters parameters;
      parameters.mass_damping = 2;
      LatticeMotion<float> motion(cells, Material("Neo-Hookean", 1000, 0.45, 1000),
                                  entries_below(cells, 0.01), {}, parameters);
      fill(cells, motion.displacement(),
           [length](const Point &X) { return Direction(Point(0, 0, (length - 1) * X[2])); });
      const LatticeVector<float> nothing(cells.nodes);
      double highest     = motion.strain_energy();
      const double start = highest;
      for (unsigned int i = 0; i < 600; ++i)
      {
        motion.advance(1. / 60, nothing, nothing, {1e-3, 10});
        highest = std::max(highest, motion.strain_energy() + motion.kinetic_energy());
      }
      EXPECT_LE(highest, 1.01 * start) << length;
      double farthest = 0;
      for (const float u : motion.displacement().entries())
        farthest = std::max<double>(farthest, std::abs(u));
      EXPECT_LT(farthest, 1e-4) << length;
      EXPECT_GT(motion.tangent().elasticity().min_jacobian(motion.displacement()), 0.9) << length;
    }
  }

  // A tool that leaps by half the body's length from frame to frame, for two iterations each.
  TEST(RoughMotion, RoughHandlingIsNoBlowUp)
  {
    const CellLattice cells       = cells_of("cylinder", Point(), 4);
    const auto base               = entries_below(cells, 0.01);
    std::vector<std::size_t> held = base, tool;
    for (const std::size_t node : cells.entries)
      for (unsigned int c = 0; c < dim && position(cells, node)[2] > 0.19; ++c)
        tool.push_back(c * cells.nodes.size() + node);
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
