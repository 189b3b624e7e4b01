// SPDX-License-Identifier: LGPL-2.1-or-later
// Motions whose steps are left after a few iterations.

#include "moving_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
  using namespace softcell;

  /// A cylinder on its base under its weight, with a tool that swings its top by 2 cm.
  struct Swung
  {
    CellLattice cells;
    std::vector<std::size_t> tool, held;
    LatticeMotion<double> motion;

    explicit Swung(const unsigned int n_cells)
        : cells(cells_of("cylinder", Point(), n_cells)),
          tool(entries_above(cells, 0.19)),
          held(entries_below(cells, 0.01)),
          motion(cells, Material("Neo-Hookean", 5000, 0.45, 1000), all_held(), {}, {})
    {
    }

    void advance(const unsigned int frame, const LatticeMotion<double>::Effort &effort)
    {
      LatticeVector<double> imposed(cells.nodes);
      const double t = frame / 60., swing = 0.01 * (1 - std::cos(M_PI * std::min(2 * t, 1.)));
      for (const std::size_t entry : tool)
        if (const std::size_t c = entry / cells.nodes.size(); c != 1)
          imposed.entries()[entry] = swing * std::sin(4 * M_PI * t + c);
      motion.advance(1. / 60, weight(cells, motion), imposed, effort);
    }

  private:
    std::vector<std::size_t> all_held() const
    {
      std::vector<std::size_t> all = held;
      all.insert(all.end(), tool.begin(), tool.end());
      return all;
    }
  };

  // In the L2 norm, by lumped masses; as in doc/dynamics.md.
  TEST(HurriedMotion, FourIterationsAStepStayNearTheConvergedMotion)
  {
    Swung hurried(5), converged(5);
    const double *const m = converged.motion.tangent().masses().component(0);
    for (unsigned int frame = 1; frame <= 30; ++frame)
    {
      hurried.advance(frame, {1e-6, 4});
      converged.advance(frame, {1e-9, 1000});
      double error = 0, size = 0;
      for (unsigned int c = 0; c < dim; ++c)
        for (const std::size_t node : converged.cells.entries)
        {
          const double u = converged.motion.displacement().component(c)[node];
          error += m[node] * std::pow(hurried.motion.displacement().component(c)[node] - u, 2);
          size += m[node] * u * u;
        }
      ASSERT_LT(std::sqrt(error / size), 0.01) << frame;
    }
  }

  // What is extrapolated at light nodes grows until a cell turns inside out.
  TEST(HurriedMotion, OneIterationAStepTanglesNoCell)
  {
    Swung body(12);
    for (unsigned int frame = 1; frame <= 60; ++frame)
    {
      body.advance(frame, {1e-6, 1});
      ASSERT_GT(body.motion.tangent().elasticity().min_jacobian(body.motion.displacement()), 0.2)
        << frame;
    }
  }

  // A node is pushed in by more than two cells and kept there. Its cells are stiffer than at rest,
  // which the preconditioner has to know.
  TEST(HurriedMotion, StepsAreSolvedWhereCellsAreSqueezed)
  {
    const int n             = 8;
    const CellLattice cells = cells_of("box", Point(0.1, 0.1, 0.1), n);
    const std::size_t node = cells.nodes.entry(n / 2, n / 2, n), size = cells.nodes.size();
    std::vector<std::size_t> held = entries_below(cells, 0.001);
    for (unsigned int c = 0; c < dim; ++c)
      held.push_back(c * size + node);
    LatticeMotion<float> motion(cells, Material("Neo-Hookean", 5000, 0.45, 1000), held, {}, {});
    const LatticeVector<float> nothing(cells.nodes);
    LatticeVector<float> imposed = nothing;
    for (unsigned int frame = 1; frame <= 20; ++frame)
    {
      imposed.entries()[2 * size + node] = -2.5 * cells.spacing[2] * std::min(frame / 10., 1.);
      const double residual = motion.advance(1. / 60, nothing, imposed, {1e-6, 4}).residual;
      if (frame > 18)
      {
        EXPECT_LT(residual, 0.01) << frame;
      }
    }
  }
} // namespace
