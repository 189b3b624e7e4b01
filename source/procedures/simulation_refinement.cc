// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop's next grid: the cells that err most are halved.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/evaluation.h>
#include <softcell/operators/error_estimate.h>
#include <softcell/output/checkpoint.h>
#include <softcell/procedures/simulation.h>

#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace softcell
{
  void Simulation::take_refinement(const std::string &checkpoint)
  {
    refinement_              = read_refinement(checkpoint, MPI_COMM_WORLD);
    const unsigned int steps = parameters_.discretization.refinement.steps;
    if (refinement_.size() > steps)
      throw BadInput("The grid of the checkpoint '" + checkpoint + "' was refined " +
                     std::to_string(refinement_.size()) +
                     " times, but Discretization/Refinement steps = " + std::to_string(steps) +
                     "; give as many at least.");
  }

  void Simulation::refine()
  {
    const double fraction            = parameters_.discretization.refinement.fraction;
    const std::vector<double> errors = cell_errors();
    std::vector<Point> inside, points;
    for (const unsigned int i : largest_errors(errors, fraction, MPI_COMM_WORLD))
    {
      discretization_->patch_points(i, points);
      inside.push_back(points[0]);
    }
    refinement_.emplace_back();
    for (const auto &some : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, inside))
      refinement_.back().insert(refinement_.back().end(), some.begin(), some.end());
    std::ostringstream text;
    text << "  refinement " << refinement_.size() << ": estimated error " << std::setprecision(3)
         << 100 * estimated_error(errors) << " %, " << refinement_.back().size()
         << " cells to halve";
    console_.say(text.str());

    const std::unique_ptr<Discretization> coarser = std::move(discretization_);
    const Vector coarser_displacement             = displacement_;
    model_.reset();
    loads_.reset();
    states_.reset();
    written_ = -1;
    build();
    displacement_ = transferred(*coarser, coarser_displacement, *discretization_, reach());
    start_        = 1;
  }

  std::vector<double> Simulation::cell_errors() const
  {
    return squared_errors(*discretization_, materials_, parameters_.discretization.projection,
                          displacement_);
  }

  double Simulation::estimated_error(const std::vector<double> &cell_errors) const
  {
    const double sum    = std::accumulate(cell_errors.begin(), cell_errors.end(), 0.);
    const double all    = dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    const double energy = model_->elasticity().energy(displacement_);
    return energy > 0 ? std::sqrt(all / (2 * energy)) : 0;
  }
} // namespace softcell
