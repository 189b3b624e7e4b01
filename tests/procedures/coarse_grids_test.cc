// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs that start from the solution on coarser grids.

#include "small_problems.h"

#include <softcell/base/exceptions.h>

namespace softcell
{
  namespace
  {
    Parameters bent_cylinder(const Method &method, const unsigned int coarse_grids)
    {
      Parameters p                = body_of("cylinder", method, 4);
      p.geometry.length           = 2;
      p.discretization.cut.levels = 1;
      p.procedure.coarse_grids    = coarse_grids;
      p.regions                   = {{"base", "z < 1e-6"}, {"end", "z > 2 - 1e-6"}};
      p.load_entries              = {{"base", "clamp"}, {"end", "traction 0, 15, 0"}};
      return p;
    }
  } // namespace

  TEST(CoarseGrids, lead_to_the_same_equilibrium_in_fewer_iterations)
  {
    for (const Method &method : {Method{"weighted cell", 1}, {"finite cell", 2}, {"tetrahedra", 1}})
    {
      SCOPED_TRACE(method.name);
      const Solved from_rest   = solve(bent_cylinder(method, 0));
      const Solved from_coarse = solve(bent_cylinder(method, 1));
      EXPECT_LT(from_coarse.row.number("newton_iterations"),
                from_rest.row.number("newton_iterations"));
      Vector difference = from_coarse.simulation->displacement();
      difference -= from_rest.simulation->displacement();
      EXPECT_LT(difference.l2_norm(), 1e-8 * from_rest.simulation->displacement().l2_norm());
    }
  }

  // One iteration a step is enough for the small steps that lead from rest, not for the start.
  TEST(CoarseGrids, that_lead_nowhere_leave_the_start_to_the_body_at_rest)
  {
    Parameters p                = bent_cylinder({"weighted cell", 1}, 1);
    p.newton.max_iterations     = 1;
    p.newton.residual_tolerance = 1e-2;
    p.newton.update_tolerance   = 0;
    const ResultsRow row        = solve(p).row;
    EXPECT_EQ(row.get("converged"), "true");
    EXPECT_GT(row.number("load_steps"), 1);
  }
} // namespace softcell
