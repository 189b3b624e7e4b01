// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop of a body in motion.

#include <softcell/procedures/simulation.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/loads/recorded_path.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

namespace softcell
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    double milliseconds(const Clock::time_point begin, const Clock::time_point end)
    {
      return std::chrono::duration<double, std::milli>(end - begin).count();
    }

    /// The tangent of all supports.
    BlockMatrix support_tangent(const Loads &loads, const Discretization &discretization)
    {
      std::vector<std::vector<unsigned int>> couplings;
      for (const auto &force : loads.forces)
        force->add_couplings(couplings);
      BlockMatrix tangent(discretization.partitioner(), couplings);
      for (const auto &force : loads.forces)
        force->add_tangent(discretization.make_vector(), 0, tangent);
      tangent.compress();
      return tangent;
    }

    /// What acts on a lattice from outside, by time.
    template <class Real>
    class Outside
    {
    public:
      Outside(const Loads &loads, const Discretization &discretization, const CellLattice &cells)
          : loads_(loads),
            cells_(cells),
            rest_(discretization.make_vector()),
            u_(rest_),
            constant_(rest_),
            sum_(rest_),
            force_(cells.nodes),
            imposed_(cells.nodes)
      {
        for (const auto &load : loads.forces)
          if (load->is_proportional())
            load->add_residual(rest_, 1, constant_);
      }

      std::vector<std::size_t> held() const
      {
        std::vector<std::size_t> entries;
        for (const unsigned int unknown : loads_.imposed.unknowns())
          entries.push_back(unknown % 3 * cells_.nodes.size() + cells_.entries[unknown / 3]);
        return entries;
      }

      /// At no displacement. Units: N
      const LatticeVector<Real> &force(const double t)
      {
        sum_ = constant_;
        for (const auto &load : loads_.forces)
          if (!load->is_proportional())
            load->add_residual(rest_, t, sum_);
        sum_ *= -1.;
        copy(sum_, cells_.entries, force_);
        return force_;
      }

      /// Units: m
      const LatticeVector<Real> &imposed(const double t)
      {
        loads_.imposed.missing(rest_, t, sum_);
        copy(sum_, cells_.entries, imposed_);
        return imposed_;
      }

      /// By region, of what moves or holds it. Units: N
      std::map<std::string, Direction>
      tool_forces(const double t, const LatticeVector<Real> &u, const LatticeVector<Real> &reaction)
      {
        std::map<std::string, Direction> forces; // a region may have several loads
        copy(u, cells_.entries, u_);
        for (const auto &load : loads_.forces)
          if (!load->is_proportional())
            forces[load->region()] += load->total_force(u_, t);
        copy(reaction, cells_.entries, u_);
        const auto &regions                   = loads_.imposed.regions();
        const std::vector<Direction> strongly = loads_.imposed.reactions(u_);
        for (unsigned int i = 0; i < regions.size(); ++i)
          forces[regions[i]] += strongly[i];
        return forces;
      }

    private:
      const Loads &loads_;
      const CellLattice &cells_;
      const Vector rest_;
      Vector u_, constant_, sum_;
      LatticeVector<Real> force_, imposed_;
    };

    std::string frames_head(const std::map<std::string, Direction> &forces)
    {
      std::string head =
        "time,step_ms,linear_iterations,linear_residual,way,kinetic_energy,strain_energy";
      for (const auto &[region, force] : forces)
        head += ',' + region + "_fx," + region + "_fy," + region + "_fz";
      return head + '\n';
    }

    double end_time(const Parameters &parameters)
    {
      if (parameters.dynamics.end_time > 0)
        return parameters.dynamics.end_time;
      return RecordedPath(parameters.loads.path).end();
    }
  } // namespace

  void Simulation::check_motion() const
  {
    const std::string place = "Solver/Mode = dynamic ";
    if (parameters_.material.model == "Saint-Venant-Kirchhoff")
      throw BadInput(place + "lets a body be squeezed flat, which Saint-Venant-Kirchhoff does not "
                             "resist; choose 'Material/Model = Neo-Hookean' or linear.");
    if (parameters_.material.density == 0)
      throw BadInput(place +
                     "needs a mass; give Material/Density, 1000 (kg/m^3) for most tissues.");
    if (parameters_.loads.imposition == "Nitsche")
      throw BadInput(place +
                     "knows no Nitsche's method; give 'Loads/Imposed displacement = penalty'.");
    if (parameters_.loads.manufactured != "none")
      throw BadInput(place +
                     "moves to no known solution; give 'Loads/Manufactured solution = none'.");
    if (parameters_.procedure.coarse_grids > 0 || parameters_.discretization.refinement.steps > 0)
      throw BadInput(place + "goes on one grid; give 'Solver/Coarse grids = 0' and "
                             "'Discretization/Refinement steps = 0'.");
    if (parameters_.dynamics.end_time == 0 && parameters_.loads.path.empty())
      throw BadInput(place + "has no end; give 'Dynamics/End time' in s.");
    if (parameters_.loads.penalty != "automatic" &&
        Expression(parameters_.loads.penalty, 1, "Loads/Penalty").uses_time())
      throw BadInput(place + "knows no Loads/Penalty = '" + parameters_.loads.penalty +
                     "' that changes with t; give one without t.");
    for (const LoadDescription &load : parse_loads(parameters_.load_entries, regions_))
    {
      using Kind = LoadDescription::Kind;
      if (load.kind == Kind::pressure || load.is_of_reference())
        throw BadInput(place + "knows no load as " + load.place +
                       "; give a traction, a displacement or springs.");
      if (load.kind == Kind::springs && Expression(load.value, 1, load.place).uses_time())
        throw BadInput(place + "knows no springs that change, as " + load.place +
                       "; give a stiffness without t.");
      if (load.kind != Kind::displacement || load.is_path())
        continue;
      const Expression displacement(load.value, 3, load.place);
      const auto [lower, upper] = body_.bounding_box().get_boundary_points();
      if (!displacement.uses_time() &&
          displacement.value(lower, 1).norm() + displacement.value(upper, 1).norm() > 0)
        throw BadInput(place + "cannot jump, as " + load.place +
                       " does at the start; let it grow with t (s), or give 'displacement path'.");
    }
  }

  template <class Real>
  void Simulation::move(const std::filesystem::path &folder)
  {
    const DynamicsParameters &dynamics = parameters_.dynamics;
    const CellLattice cells            = cell_lattice(*discretization_);
    const BlockMatrix supports         = support_tangent(*loads_, *discretization_);
    Outside<Real> outside(*loads_, *discretization_, cells);
    LatticeMotion<Real> motion(cells, materials_[0], outside.held(),
                               LatticeMatrix<Real>(supports, cells.entries, cells.nodes),
                               dynamics.motion());
    copy(displacement_, cells.entries, motion.displacement());
    const LatticeMotion<Real> &now = motion;
    const double dt                = 1 / dynamics.steps_per_second;
    const double middle            = dynamics.motion().scheme == TimeScheme::newmark ? 0.5 : 1;
    const unsigned int n_frames =
      std::lround(std::ceil(end_time(parameters_) * dynamics.steps_per_second - 1e-6));
    const unsigned int every = parameters_.output.every;
    typename LatticeMotion<Real>::Effort effort;
    Clock::duration forces_took{}; // the tool's forces, in the last step
    effort.tolerance      = parameters_.linear_solver.tolerance;
    effort.max_iterations = parameters_.linear_solver.max_iterations;
    std::ostringstream table;
    table.precision(9);
    for (unsigned int frame = 1; frame <= n_frames; ++frame)
    {
      const double t   = frame / dynamics.steps_per_second;
      const auto begin = Clock::now();
      if (dynamics.frame_budget > 0)
        effort.deadline =
          begin + std::chrono::microseconds(std::lround(1e3 * dynamics.frame_budget)) - forces_took;
      const auto step =
        motion.advance(dt, outside.force(t - (1 - middle) * dt), outside.imposed(t), effort);
      const auto solved      = Clock::now();
      motion_.forces         = outside.tool_forces(t, now.displacement(), now.reaction());
      const auto end         = Clock::now();
      forces_took            = end - solved;
      const double ms        = milliseconds(begin, end);
      motion_.slowest_ms     = std::max(motion_.slowest_ms, ms);
      motion_.kinetic_energy = motion.kinetic_energy();
      motion_.n_late += dynamics.frame_budget > 0 && ms > dynamics.frame_budget;
      motion_.n_shortened += step.way < 1;
      table << (frame == 1 ? frames_head(motion_.forces) : "") << t << ',' << ms << ','
            << step.iterations << ',' << step.residual << ',' << step.way << ','
            << motion_.kinetic_energy << ',' << motion.strain_energy();
      for (const auto &[region, force] : motion_.forces)
        table << ',' << force[0] << ',' << force[1] << ',' << force[2];
      table << '\n';
      history_.linear_iterations += step.iterations;
      most_linear_iterations_ = std::max(most_linear_iterations_, step.iterations);
      console_.progress("  frame " + std::to_string(frame) + " of " + std::to_string(n_frames) +
                        ": " + std::to_string(step.iterations) + " linear iterations");
      copy(now.displacement(), cells.entries, displacement_);
      if (every > 0 && frame % every == 0)
        write_state(folder, t);
    }
    motion_.n_steps    = n_frames;
    history_.reached   = n_frames / dynamics.steps_per_second;
    history_.converged = true;
    make_folder(folder.string());
    write_file((folder / "frames.csv").string(), table.str());
    say_motion();
  }

  void Simulation::say_motion()
  {
    std::ostringstream text;
    text << "  " << motion_.n_steps << " steps to t = " << history_.reached << " s, "
         << history_.linear_iterations << " linear iterations, the slowest step took "
         << std::setprecision(3) << motion_.slowest_ms << " ms";
    console_.say(text.str());
    if (motion_.n_shortened > 0)
      warn({std::to_string(motion_.n_shortened) + " of " + std::to_string(motion_.n_steps) +
            " steps went only a part of their way, as the body would have gained energy (column "
            "way of frames.csv); give more Dynamics/Steps per second or a slower motion."});
    if (motion_.n_late == 0)
      return;
    std::ostringstream warning;
    warning << motion_.n_late << " of " << motion_.n_steps
            << " steps took longer than Dynamics/Frame budget = "
            << parameters_.dynamics.frame_budget << " ms, the slowest " << std::setprecision(3)
            << motion_.slowest_ms
            << " ms; give fewer Discretization/Cells, more ms or more threads (OMP_NUM_THREADS).";
    warn({warning.str()});
  }

  template void Simulation::move<double>(const std::filesystem::path &);
  template void Simulation::move<float>(const std::filesystem::path &);
} // namespace softcell
