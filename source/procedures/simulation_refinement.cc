// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop's next grid: the cells that err most are halved.

#include <softcell/discretization/evaluation.h>
#include <softcell/operators/error_estimate.h>
#include <softcell/procedures/simulation.h>

#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace softcell
{
  void Simulation::refine()
  {
    const double fraction            = parameters_.discretization.refinement.fraction;
    const std::vector<double> errors = squared_errors(*discretization_, materials_, displacement_);
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

  double Simulation::estimated_error(const std::vector<double> &squared_errors) const
  {
    const double sum = std::accumulate(squared_errors.begin(), squared_errors.end(), 0.);
    return std::sqrt(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD) /
                     (2 * model_->elasticity().energy(displacement_)));
  }
} // namespace softcell
