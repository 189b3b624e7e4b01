// SPDX-License-Identifier: LGPL-2.1-or-later
// Two figures of Brunet's chapter 4, on small grids.

#include "small_problems.h"

#include <cmath>
#include <utility>

namespace softcell
{
  namespace
  {
    Parameters cylinder(const Method &method, const unsigned int levels, const double length)
    {
      Parameters p                = body_of("cylinder", method, 4);
      p.geometry.radius           = 0.05;
      p.geometry.length           = length;
      p.material.young_modulus    = 5000;
      p.discretization.cut.levels = levels;
      p.newton                    = NewtonParameters();
      p.load_steps.steps          = "adaptive";
      p.regions = {{"base", "z < 1e-6"}, {"top", "z > " + std::to_string(length) + " - 1e-6"}};
      return p;
    }
  } // namespace

  /// Figure 4.8, where finite cells took up to 150 increments.
  TEST(Brunet, threefold_stretch_takes_three_load_steps_at_most)
  {
    for (const auto &[name, levels] :
         {std::pair("finite cell", 1u), {"finite cell", 3u}, {"weighted cell", 1u}})
    {
      SCOPED_TRACE(name + std::to_string(levels));
      Parameters p   = cylinder({name, 1}, levels, 0.05);
      p.load_entries = {{"base", "displacement 0, 0, -0.05"}, {"top", "displacement 0, 0, 0.05"}};
      const ResultsRow row = solve(p).row;
      EXPECT_LE(row.number("load_steps"), 3);
      EXPECT_GT(row.number("min_jacobian"), 0);
      EXPECT_GT(row.number("top_fz"), 0);
      EXPECT_NEAR(row.number("base_fz"), -row.number("top_fz"), 1e-6 * row.number("top_fz"));
    }
  }

  /// Figure 4.6: the weighted cell is within 5 % of the finite cell.
  TEST(Brunet, bent_cylinder_of_weighted_cells_is_near_that_of_finite_cells)
  {
    for (const unsigned int levels : {1, 2})
    {
      const auto tip = [&](const char *method) {
        Parameters p   = cylinder({method, 1}, levels, 0.6);
        p.load_entries = {{"base", "clamp"}, {"top", "traction 0, -30, 0"}};
        p.probes       = {{"tip", "0, 0, 0.6"}};
        return solve(p).row.number("tip_uy");
      };
      const double finite = tip("finite cell"), weighted = tip("weighted cell");
      if (is_root())
      {
        EXPECT_LT(finite, -0.3); // bent by half of its length, as in the figure
        EXPECT_NEAR(weighted, finite, 0.05 * std::abs(finite));
      }
    }
  }
} // namespace softcell
