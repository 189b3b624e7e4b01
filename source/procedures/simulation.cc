// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop.

#include <softcell/procedures/simulation.h>

#include <softcell/base/exceptions.h>
#include <softcell/discretization/evaluation.h>
#include <softcell/discretization/methods.h>
#include <softcell/output/checkpoint.h>
#include <softcell/procedures/expected_memory.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace softcell
{
  namespace
  {
    std::vector<Material> make_materials(const Parameters &parameters, const Body &body)
    {
      std::vector<Material> materials;
      std::map<std::string, MaterialParameters> unused = parameters.label_materials;
      for (unsigned int label = 0; label < body.n_labels(); ++label)
      {
        const std::string name             = body.label_name(label);
        const auto own                     = parameters.label_materials.find(name);
        const bool has_own                 = own != parameters.label_materials.end();
        const MaterialParameters &material = has_own ? own->second : parameters.material;
        materials.emplace_back(material.model, material.young_modulus, material.poisson_ratio,
                               material.density, has_own ? "Material " + name : "Material");
        unused.erase(name);
      }
      if (!unused.empty())
      {
        std::string names;
        for (unsigned int label = 0; label < body.n_labels(); ++label)
          names += (label == 0 ? "" : ", ") + body.label_name(label);
        throw BadInput("There is a section 'Material " + unused.begin()->first +
                       "', but the body has no such label; it has: " + names + ".");
      }
      return materials;
    }

    std::vector<Point> probe_points(const Parameters &parameters)
    {
      std::vector<Point> points;
      for (const auto &[name, text] : parameters.probes)
      {
        std::istringstream stream(text);
        Point X;
        char comma[2] = {',', ','};
        if (!(stream >> X[0] >> comma[0] >> X[1] >> comma[1] >> X[2]) ||
            !(stream >> std::ws).eof() || comma[0] != ',' || comma[1] != ',')
          throw BadInput("Probes/" + name + " = '" + text +
                         "' is not a point; give three numbers in m, as 0, 0, 0.6.");
        points.push_back(X);
      }
      return points;
    }

    /// What a user should know of cells that nearly incompressible materials make too stiff; empty
    /// if there are none.
    std::string locking(const DiscretizationParameters &parameters,
                        const std::vector<Material> &materials)
    {
      double largest = 0;
      for (const Material &material : materials)
        largest = std::max(largest, material.poisson_ratio());
      const bool is_tetrahedra = parameters.method == "tetrahedra";
      if (largest < 0.485 || parameters.degree > 1 || (parameters.projection && !is_tetrahedra))
        return "";
      std::ostringstream text;
      text << "A Poisson ratio of " << largest << " makes "
           << (is_tetrahedra ? "tetrahedra" : "cells")
           << " of degree 1 too stiff (locking); set 'Discretization/Degree = 2'";
      if (!is_tetrahedra)
        text << " or 'Discretization/Volumetric projection = true'";
      return text.str() + '.';
    }

    /// @throws BadInput if there can be no coarse grids.
    void check_coarse_grids(const Parameters &parameters)
    {
      if (parameters.procedure.coarse_grids == 0)
        return;
      if (!parameters.procedure.start_from.empty())
        throw BadInput("Solver/Coarse grids and Solver/Start from = " +
                       parameters.procedure.start_from + " are two starts; remove one of them.");
      if (!parameters.discretization.mesh.file.empty())
        throw BadInput("Solver/Coarse grids cannot coarsen Discretization/Mesh file = " +
                       parameters.discretization.mesh.file + "; remove one of the two.");
    }

    /// @throws BadInput if what runs without a matrix has no background grid, or one to be refined.
    void check_matrix_free(const Parameters &parameters)
    {
      if (!parameters.linear_solver.is_matrix_free())
        return;
      const std::string &method = parameters.discretization.method;
      const std::string what    = parameters.procedure.mode == "dynamic"
                                    ? "'Solver/Mode = dynamic'"
                                    : "'Solver/Preconditioner = geometric multigrid'";
      if (method == "tetrahedra" || method == "hexahedra")
        throw BadInput("Discretization/Method = " + method + " has no background grid, which " +
                       what + " needs; choose weighted cell, moment fitting or sparse grid.");
      if (parameters.discretization.refinement.steps > 0)
        throw BadInput("Discretization/Refinement steps = " +
                       std::to_string(parameters.discretization.refinement.steps) +
                       " makes cells of several sizes, where " + what +
                       " needs cells of one; give 'Refinement steps = 0'.");
    }

    /// The same run with cells of twice the edge.
    Parameters coarser(Parameters parameters)
    {
      --parameters.procedure.coarse_grids;
      parameters.discretization.refinement.steps = 0;
      parameters.discretization.grid.cell_size *= 2;
      parameters.discretization.mesh.size *= 2;
      for (unsigned int &n : parameters.discretization.grid.cells)
        n = (n + 1) / 2;
      parameters.probes.clear();
      parameters.output.every = 0;
      return parameters;
    }

    std::string in_digits(const double value, const int digits = 2)
    {
      std::ostringstream text;
      text << std::setprecision(digits) << std::scientific << value;
      return text.str();
    }
  } // namespace

  Simulation::Simulation(const std::string &name,
                         const Parameters &parameters,
                         const Body &body,
                         Console &console,
                         const DisplacementField *const reference)
      : name_(name),
        parameters_(parameters),
        body_(body),
        console_(console),
        materials_(make_materials(parameters, body)),
        regions_(make_regions(parameters.regions)),
        probes_(probe_points(parameters))
  {
    if (reference != nullptr)
      reference_.emplace(*reference);
    parameters.load_steps.n_steps(); // throws if it is no number
    check_coarse_grids(parameters);
    if (is_dynamic())
    {
      check_motion();
      parameters_.linear_solver.solver         = "CG"; // there is no matrix
      parameters_.linear_solver.preconditioner = "geometric multigrid";
      for (Material &material : materials_)
        material = material.invertible();
    }
    check_matrix_free(parameters_);
    check_memory(parameters, body, MPI_COMM_WORLD);
    if (!parameters.procedure.start_from.empty())
      take_refinement(parameters.procedure.start_from);
    build();
    if (const unsigned int steps = parameters.discretization.refinement.steps; steps > 0)
      console_.say("  before " + std::to_string(steps) + (steps == 1 ? " step" : " steps") +
                   " of refinement, whose cells and memory are not foreseen");
    if (const std::string warning = locking(parameters.discretization, materials_);
        !warning.empty())
    {
      if (parameters.procedure.coarse_grids == 0) // of all grids to start from, one says it
        console_.warn(warning);
      remarks_.push_back(warning);
    }
    if (!parameters.procedure.start_from.empty())
      start_from(parameters.procedure.start_from);
    if (parameters.procedure.coarse_grids > 0)
    {
      console_.say("  A coarser grid to start from:");
      coarser_ = std::make_unique<Simulation>(name + " coarser", coarser(parameters), body, console,
                                              reference);
    }
  }

  Simulation::~Simulation() = default;

  void Simulation::build()
  {
    const Timers::Scope scope(timers_, "setup");
    const std::vector<LoadDescription> loads = parse_loads(parameters_.load_entries, regions_);
    std::vector<std::string> remarks;
    discretization_ = make_discretization(parameters_.discretization, parameters_.geometry, body_,
                                          MPI_COMM_WORLD, remarks, refinement_);
    size_           = discretization_->size();
    console_.say("  " + std::to_string(size_.cells) + " cells, " + std::to_string(size_.cut_cells) +
                 " of them cut, " + std::to_string(size_.unknowns) + " unknowns, " +
                 std::to_string(size_.integration_points) + " integration points");
    if (size_.unfitted_cells > 0)
      remarks.push_back("In " + std::to_string(size_.unfitted_cells) + " of " +
                        std::to_string(size_.cut_cells) +
                        " cut cells moment fitting did not find few points and keeps the finite "
                        "cell's, which are as accurate but many: assembling takes longer there.");
    warn(remarks);

    loads_ = std::make_unique<Loads>(make_loads(parameters_.loads, loads, regions_,
                                                *discretization_, body_.surface(), materials_,
                                                reference_ ? &*reference_ : nullptr));
    if (!loads_->free_motions.empty() && !is_dynamic())
      throw BadInput("Loads: " + loads_->free_motions);
    warn(loads_->warnings);
    displacement_ = discretization_->make_vector();
    check_probes();
    model_ =
      std::make_unique<Model>(*discretization_, materials_, parameters_.discretization.projection,
                              *loads_, parameters_.linear_solver, timers_);
  }

  void Simulation::warn(const std::vector<std::string> &remarks)
  {
    for (const std::string &remark : remarks)
      if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end())
      {
        console_.warn(remark);
        remarks_.push_back(remark);
      }
  }

  void Simulation::check_probes() const
  {
    const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    const std::vector<double> distances =
      evaluate(*discretization_, displacement_, is_root ? probes_ : std::vector<Point>(), reach())
        .distances;
    const auto [lower, upper] = body_.bounding_box().get_boundary_points();
    const double near         = 0.01 * (upper - lower).norm(); // surfaces are approximations
    const auto is_in_body     = [&](const unsigned int i) {
      const Point &X = probes_[i];
      return std::isfinite(distances[i]) &&
             (body_.contains(X) || X.distance(body_.surface().nearest(X).first) < near);
    };
    unsigned int first = 0;
    while (is_root && first < probes_.size() && is_in_body(first))
      ++first;
    first = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, first);
    if (first == probes_.size())
      return;
    std::ostringstream text;
    text << "Probes/" << parameters_.probes[first].first << " = '"
         << parameters_.probes[first].second << "' is not in the body, which lies between ("
         << lower << ") and (" << upper << "); lengths are in m.";
    throw BadInput(text.str());
  }

  void Simulation::start_from(const std::string &checkpoint)
  {
    start_ = read_checkpoint(checkpoint, *discretization_, displacement_);
    try
    {
      model_->elasticity().energy(displacement_);
    }
    catch (const InvertedPoint &)
    {
      throw BadInput("The checkpoint '" + checkpoint +
                     "' turns a part of the body inside out, where the material has no stress; "
                     "start from another one.");
    }
  }

  void Simulation::start_from_coarser()
  {
    const Timers::Scope scope(timers_, "coarse grids");
    coarser_->solve("");
    start_ = coarser_->history_.reached;
    displacement_ =
      transferred(coarser_->discretization(), coarser_->displacement(), *discretization_, reach());
    coarser_.reset();
  }

  bool Simulation::solve(const std::filesystem::path &folder)
  {
    const Timers::Scope scope(timers_, "solve");
    if (is_dynamic())
    {
      if (parameters_.dynamics.frame_budget > 0)
        move<float>(folder);
      else
        move<double>(folder);
      return history_.converged;
    }
    const auto follow_from_rest = [&] {
      console_.say("  from the coarser grid: " + history_.reason + "; starting from rest");
      const LoadHistory failed = history_;
      displacement_            = 0;
      start_                   = 0;
      follow(folder);
      history_.newton_iterations += failed.newton_iterations;
      history_.linear_iterations += failed.linear_iterations;
    };
    const bool has_coarser = coarser_ != nullptr;
    if (has_coarser)
      start_from_coarser();
    follow(folder);
    if (has_coarser && history_.load_steps == 0)
      follow_from_rest();
    while (history_.converged && refinement_.size() < parameters_.discretization.refinement.steps)
    {
      refine();
      follow(folder);
      if (history_.load_steps == 0)
        follow_from_rest();
    }
    return history_.converged;
  }

  void Simulation::follow(const std::filesystem::path &folder)
  {
    std::string step_text;
    unsigned int n_iterations = 0, n_linear_iterations = 0, n_accepted = 0;
    double residual       = 0;
    const auto begin_step = [&](const LoadStep &step) {
      if (step.attempt > 1)
        console_.say(step_text + ": failed after " + std::to_string(n_iterations) + " iterations");
      std::ostringstream text;
      text << "  load " << std::setprecision(4) << step.from << " -> " << step.to;
      step_text    = text.str();
      n_iterations = n_linear_iterations = 0;
      console_.progress(step_text);
    };
    const auto report = [&](const NewtonIteration &iteration) {
      n_iterations = iteration.iteration;
      n_linear_iterations += iteration.linear_iterations;
      most_linear_iterations_ = std::max(most_linear_iterations_, iteration.linear_iterations);
      residual                = iteration.residual;
      std::ostringstream text;
      text << step_text << ", iteration " << iteration.iteration << ": residual "
           << in_digits(iteration.residual) << ", update " << in_digits(iteration.update)
           << ", step " << std::setprecision(3) << iteration.step << ", "
           << iteration.linear_iterations << " linear iterations";
      console_.progress(text.str());
    };
    const auto accepted = [&](const LoadStep &step, const Vector &) {
      console_.say(step_text + ": " + std::to_string(n_iterations) + " iterations, residual " +
                   in_digits(residual) + ", " + std::to_string(n_linear_iterations) +
                   " linear iterations");
      const unsigned int every = parameters_.output.every;
      if (every > 0 && ++n_accepted % every == 0)
        write_state(folder, step.to);
    };
    history_ = follow_load(
      model_->equations(), parameters_.newton, parameters_.load_steps,
      [&](const double t) { model_->set_load(t); }, displacement_, begin_step, report, accepted,
      start_);
  }

  std::string Simulation::reason() const
  {
    if (is_dynamic())
      return history_.reason;
    return history_.reason +
           "; the state that was reached is written: look there for the least J; " +
           "a smaller load, more cells" +
           (parameters_.material.model == "Saint-Venant-Kirchhoff"
              ? " or, since Saint-Venant-Kirchhoff softens under compression, 'Material/Model = "
                "Neo-Hookean'"
              : " or a smaller 'Solver/Smallest load step'") +
           " may help";
  }

  double Simulation::reach() const
  {
    const auto [lower, upper] = body_.bounding_box().get_boundary_points();
    return 0.1 * (upper - lower).norm();
  }
} // namespace softcell
