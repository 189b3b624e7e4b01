// SPDX-License-Identifier: LGPL-2.1-or-later
// What results.csv says of the error of a case.

#include <softcell/studies/case_errors.h>

#include <softcell/studies/difference.h>

#include <sstream>

namespace softcell
{
  namespace
  {
    Difference error_of(const Simulation &simulation, const Simulation *const reference)
    {
      const Discretization &discretization = simulation.discretization();
      if (!simulation.exact())
        return difference(discretization, simulation.displacement(), reference->discretization(),
                          reference->displacement(), simulation.materials(), simulation.reach());
      const auto points =
        finer_points(simulation.parameters().discretization, simulation.parameters().geometry,
                     simulation.body(), discretization.communicator());
      return difference(discretization, simulation.displacement(), *points, *simulation.exact(),
                        simulation.materials(), simulation.reach());
    }

    /// @return the fraction of the volume that they leave out.
    double set_errors(Simulation &simulation, const Simulation *reference, ResultsRow &row)
    {
      const Timers::Scope scope(simulation.timers(), "errors");
      const Difference error = error_of(simulation, reference);
      row.set("relative_l2_error", error.relative_l2);
      row.set("relative_h1_error", error.relative_h1);
      row.set("relative_stress_error", error.relative_stress);
      if (reference)
      {
        const SurfaceDifference surface = surface_difference(
          simulation.field(), reference->field(), simulation.body().surface().vertices());
        row.set("mean_surface_error", surface.mean);
        row.set("max_surface_error", surface.max);
      }
      return error.missed;
    }
  } // namespace

  std::string add_errors(Simulation &simulation, const Simulation *const reference, ResultsRow &row)
  {
    const double missed = set_errors(simulation, reference, row);
    row.set("errors_s", simulation.timers().seconds("errors"));
    if (missed == 0)
      return "";
    std::ostringstream text;
    text.precision(2);
    text << "the errors leave out " << 100 * missed
         << " % of the reference's volume, which no cell is near; give more cells.";
    return text.str();
  }
} // namespace softcell
