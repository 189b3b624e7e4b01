// SPDX-License-Identifier: LGPL-2.1-or-later
// The strain energy is the work of the loads.

#include "small_problems.h"

#include <softcell/discretization/evaluation.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    /// The displacement, integrated over a region. Units: m^3
    Direction integral_over(const Simulation &simulation, const Region &region)
    {
      Direction sum;
      for (const SurfacePatch &patch : simulation.discretization().surface_patches(region))
        for (unsigned int q = 0; q < patch.weights.size(); ++q)
          sum += patch.weights[q] *
                 interpolate(View<const unsigned int>(patch.nodes.data(), patch.nodes.size()),
                             patch.shapes.value(q), simulation.displacement());
      return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    }
  } // namespace

  /// Clapeyron: the energy of a linear body is half the work of its loads.
  TEST(Energy, of_a_linear_body_is_half_the_work)
  {
    Parameters p         = body_of("cylinder", {"weighted cell", 1}, 4);
    p.material.model     = "linear";
    p.regions            = {{"base", "z < 1e-9"}, {"top", "z > 1 - 1e-9"}};
    p.load_entries       = {{"base", "clamp"}, {"top", "displacement 0, 0, 0.2"}};
    const ResultsRow row = solve(p).row;
    EXPECT_NEAR(row.number("strain_energy"), row.number("top_fz") * 0.2 / 2, 1e-9);

    p.load_entries         = {{"base", "clamp"}, {"top", "traction 0, 0, 30"}};
    const ResultsRow force = solve(p).row;
    EXPECT_GT(force.number("strain_energy"), 0.1);
    EXPECT_NEAR(force.number("strain_energy"), -force.number("load_energy") / 2, 1e-9);

    p.load_entries.push_back({"top", "pressure 1"}); // which has no potential
    EXPECT_EQ(solve(p).row.get("load_energy"), "");
  }

  /// Of a Neo-Hookean body, it is the work along the path of equilibria; the trapezoidal sum over
  /// load steps is off by the square of the step.
  TEST(Energy, of_a_neo_hookean_body_is_the_work_along_the_path)
  {
    const unsigned int n = 8;
    const Direction traction({150, 0, 200});
    for (const Method &method : {Method{"weighted cell", 1}, {"finite cell", 1}, {"tetrahedra", 1}})
    {
      SCOPED_TRACE(method.name);
      std::vector<Direction> integrals(1);
      double energy = 0;
      for (unsigned int step = 1; step <= n; ++step)
      {
        Parameters p = body_of("cylinder", method, 4);
        p.regions    = {{"base", "z < 1e-9"}, {"top", "z > 1 - 1e-9"}};
        std::ostringstream text;
        text.precision(17);
        text << "traction " << traction[0] * step / n << ", 0, " << traction[2] * step / n;
        p.load_entries      = {{"base", "clamp"}, {"top", text.str()}};
        const Solved solved = solve(p);
        integrals.push_back(integral_over(*solved.simulation, Region("top", "z > 1 - 1e-9")));
        energy = solved.row.number("strain_energy");
      }
      EXPECT_GT(integrals[n].norm(), 0.2); // large strains
      const auto error = [&](const unsigned int stride) {
        double work = 0;
        for (unsigned int step = stride; step <= n; step += stride)
          work +=
            (step - 0.5 * stride) / n * traction * (integrals[step] - integrals[step - stride]);
        return work / energy - 1;
      };
      // an expansion in even powers of the step, without a constant
      EXPECT_NEAR(error(2) / error(1), 4, 0.2);
    }
  }
} // namespace softcell
