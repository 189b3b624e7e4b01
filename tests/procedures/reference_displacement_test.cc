// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement of one run imposed on the surface of another.

#include "small_problems.h"

#include <softcell/base/exceptions.h>

namespace softcell
{
  namespace
  {
    Parameters held_box(const char *const method, const unsigned int cells, const char *const load)
    {
      Parameters p   = body_of("box", {method, 1}, cells);
      p.regions      = {{"skin", "1"}};
      p.load_entries = {{"skin", load}};
      p.probes       = {{"inside", "0.4, 0.3, 0.7"}};
      return p;
    }

    /// A linear displacement is in every grid, a refined one too, so that it comes back exactly.
    TEST(ReferenceDisplacementTest, linear_one_comes_back_from_another_grid)
    {
      const Solved reference =
        solve(held_box("hexahedra", 3, "displacement 0.1*z, -0.05*x, 0.02*y + 0.1*z"));
      const DisplacementField field = reference.simulation->field();
      for (const char *const method : {"hexahedra", "tetrahedra", "finite cell"})
      {
        Parameters p                      = held_box(method, 2, "displacement reference");
        p.discretization.refinement.steps = std::string(method) == "finite cell" ? 1 : 0;
        std::ostringstream log;
        Console console(log, false, 1e9);
        Simulation simulation("test", p, *reference.body, console, &field);
        ASSERT_TRUE(simulation.solve("")) << simulation.reason();
        const ResultsRow row = simulation.row();
        if (is_root())
        {
          const Direction error = vector_in(row, "inside_u") - Direction({0.07, -0.02, 0.076});
          EXPECT_LT(error.norm(), 1e-10) << method;
        }
      }
    }

    TEST(ReferenceDisplacementTest, there_must_be_a_reference)
    {
      const Parameters p = held_box("hexahedra", 2, "displacement reference");
      EXPECT_THROW(solve(p), BadInput);
    }
  } // namespace
} // namespace softcell
