// SPDX-License-Identifier: LGPL-2.1-or-later
// What the main loop leaves behind.

#include <softcell/base/collective.h>
#include <softcell/base/files.h>
#include <softcell/discretization/evaluation.h>
#include <softcell/discretization/methods.h>
#include <softcell/output/checkpoint.h>
#include <softcell/procedures/simulation.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace softcell
{
  namespace
  {
    /// (int |u|^2 dV)^(1/2). Units: m^(5/2)
    double l2_norm(const Discretization &discretization, const Vector &u)
    {
      double sum = 0;
      PatchStorage storage;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
      {
        const Patch patch = discretization.patch(i, storage);
        for (unsigned int q = 0; q < patch.n_points(); ++q)
          sum +=
            interpolate(patch.nodes, patch.shapes->value(q), u).norm_square() * patch.weights[q];
      }
      return std::sqrt(dealii::Utilities::MPI::sum(sum, discretization.communicator()));
    }
  } // namespace

  ResultsRow Simulation::row() const
  {
    const Elasticity &elasticity = model_->elasticity();
    ResultsRow row;
    row.set("case", name_);
    row.set("method", parameters_.discretization.method);
    row.set("degree", discretization_->degree());
    if (has_cut_levels(parameters_.discretization.method))
      row.set("cut_levels", parameters_.discretization.cut.levels);
    row.set("cells", size_.cells);
    row.set("cut_cells", size_.cut_cells);
    row.set("dofs", size_.unknowns);
    row.set("integration_points", size_.integration_points);
    row.set("linear_iterations", history_.linear_iterations);
    row.set("setup_s", timers_.seconds("setup"));
    row.set("solve_s", timers_.seconds("solve") - timers_.seconds("states"));
    row.set("total_s", timers_.total());
    row.set("peak_rss_mib", peak_rss_mib(MPI_COMM_WORLD));
    row.set("volume", elasticity.volume());
    row.set("strain_energy", elasticity.energy(displacement_));
    row.set("l2_displacement", l2_norm(*discretization_, displacement_));
    row.set("min_jacobian", elasticity.min_jacobian(displacement_));
    row.set("converged", history_.converged);
    if (is_dynamic())
      add_motion(row);
    else
      add_equilibrium(row);
    row.set("most_linear_iterations", most_linear_iterations_);
    row.set("cell_size", cell_size());
    if (size_.smallest_cut < 1)
      row.set("smallest_cut", size_.smallest_cut);
    if (parameters_.discretization.method == "moment fitting")
      row.set("unfitted_cells", size_.unfitted_cells);
    if (const unsigned int steps = parameters_.discretization.refinement.steps; steps > 0)
    {
      row.set("refinement_steps", steps);
      row.set("estimated_error", estimated_error(cell_errors()));
    }
    if (const double energy = model_->stabilization().energy(displacement_); energy > 0)
      row.set("stabilization_energy", energy);
    if (const double condition = model_->condition(); std::isfinite(condition))
      row.set("condition", condition);

    const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    const PointValues at_probes =
      evaluate(*discretization_, displacement_, is_root ? probes_ : std::vector<Point>(), reach());
    const char *const axes[] = {"x", "y", "z"};
    for (unsigned int i = 0; is_root && i < probes_.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        row.set(parameters_.probes[i].first + "_u" + axes[c], at_probes.displacements[i][c]);

    std::map<std::string, Direction> forces = motion_.forces; // a region may have several loads
    if (!is_dynamic())
      for (const auto &[region, force] : model_->region_forces(displacement_))
        forces[region] += force;
    for (const auto &[region, force] : forces)
      for (unsigned int c = 0; c < 3; ++c)
        row.set(region + "_f" + axes[c], force[c]);
    return row;
  }

  void Simulation::add_motion(ResultsRow &row) const
  {
    row.set("time", history_.reached);
    row.set("time_steps", motion_.n_steps);
    row.set("slowest_step_ms", motion_.slowest_ms);
    if (parameters_.dynamics.frame_budget > 0)
      row.set("late_steps", motion_.n_late);
    row.set("shortened_steps", motion_.n_shortened);
    row.set("unsolved_steps", motion_.n_unsolved);
    row.set("largest_linear_residual", motion_.largest_residual);
    row.set("kinetic_energy", motion_.kinetic_energy);
  }

  void Simulation::add_equilibrium(ResultsRow &row) const
  {
    row.set("load_steps", history_.load_steps);
    row.set("newton_iterations", history_.newton_iterations);
    row.set("assembly_s", timers_.mean("assembly"));
    row.set("load_factor", history_.reached);
    if (const double energy = model_->load_energy(displacement_); std::isfinite(energy))
      row.set("load_energy", energy);
  }

  double Simulation::cell_size() const
  {
    const DiscretizationParameters &parameters = parameters_.discretization;
    if (size_.cell_size > 0)
      return size_.cell_size;
    if (parameters.method == "tetrahedra" && parameters.mesh.size > 0)
      return parameters.mesh.size;
    const Box box = body_.bounding_box();
    return std::min({box.side_length(0), box.side_length(1), box.side_length(2)}) /
           parameters.grid.cells[0];
  }

  void Simulation::write(const std::filesystem::path &folder)
  {
    write_state(folder, history_.reached);
    if (parameters_.output.surface)
    {
      const Timers::Scope scope(timers_, "surface");
      const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
      const PointValues values =
        evaluate(*discretization_, displacement_,
                 is_root ? body_.surface().vertices() : std::vector<Point>(), reach());
      on_root(MPI_COMM_WORLD, [&] {
        write_deformed_surface((folder / "surface.vtp").string(), body_.surface(),
                               values.displacements);
      });
    }
    timers_.print(console_);
  }

  void Simulation::write_state(const std::filesystem::path &folder, const double load_factor)
  {
    if (load_factor == written_)
      return;
    const Timers::Scope scope(timers_, "states");
    on_root(MPI_COMM_WORLD, [&] { make_folder(folder.string()); });
    if (parameters_.output.volume)
    {
      if (!states_)
        states_ =
          std::make_unique<SolutionWriter>(*discretization_, (folder / "solution").string());
      states_->write(load_factor, displacement_, model_->elasticity().averages(displacement_));
    }
    if (parameters_.output.checkpoint)
      write_checkpoint((folder / "checkpoint.h5").string(), *discretization_, displacement_,
                       load_factor, refinement_);
    written_ = load_factor;
  }
} // namespace softcell
