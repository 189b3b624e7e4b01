// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop of a body in motion.

#include <softcell/procedures/simulation.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/loads/recorded_path.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

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

    /// What a step came to.
    struct Frame
    {
      double time = 0, step_ms = 0; // s, ms
      unsigned int linear_iterations = 0;
      double linear_residual = 0, way = 1;
      double kinetic_energy = 0, strain_energy = 0; // J
      std::map<std::string, Direction> forces;      // by region. Units: N
    };

    std::string frames_head(const std::map<std::string, Direction> &forces)
    {
      std::string head =
        "time,step_ms,linear_iterations,linear_residual,way,kinetic_energy,strain_energy";
      for (const auto &[region, force] : forces)
        head += ',' + region + "_fx," + region + "_fy," + region + "_fz";
      return head + '\n';
    }

    std::string frames_row(const Frame &frame)
    {
      std::ostringstream row;
      row.precision(9);
      row << frame.time << ',' << frame.step_ms << ',' << frame.linear_iterations << ','
          << frame.linear_residual << ',' << frame.way << ',' << frame.kinetic_energy << ','
          << frame.strain_energy;
      for (const auto &[region, force] : frame.forces)
        row << ',' << force[0] << ',' << force[1] << ',' << force[2];
      row << '\n';
      return row.str();
    }

    /// What is no number, or too large for the single precision of written states; empty if nothing
    /// is.
    /// @param stretch no less than that of the body.
    std::string not_finite(const Frame &frame, const double stretch)
    {
      std::vector<std::pair<std::string, double>> numbers = {
        {"strain energy", frame.strain_energy},
        {"kinetic energy", frame.kinetic_energy},
        {"deformation", stretch * stretch * stretch}, // J
        {"residual of its linear system", frame.linear_residual}};
      for (const auto &[region, force] : frame.forces)
        numbers.emplace_back("force on " + region, force.norm());
      for (const auto &[name, number] : numbers)
        if (!(std::abs(number) <= std::numeric_limits<float>::max()))
          return "the " + name + " is no finite number of single precision";
      return "";
    }

    std::string in_seconds(const double t)
    {
      std::ostringstream text;
      text << "t = " << t << " s";
      return text.str();
    }

    /// The steps of a body in motion, and what acts on it from outside. Real is the precision.
    template <class Real>
    class Steps
    {
    public:
      Steps(const Parameters &parameters,
            const Material &material,
            const Loads &loads,
            const Discretization &discretization,
            const Vector &start)
          : dynamics_(parameters.dynamics),
            middle_(dynamics_.motion().scheme == TimeScheme::newmark ? 0.5 : 1),
            cells_(cell_lattice(discretization)),
            outside_(loads, discretization, cells_),
            motion_(cells_,
                    material,
                    outside_.held(),
                    LatticeMatrix<Real>(support_tangent(loads, discretization),
                                        cells_.entries,
                                        cells_.nodes),
                    dynamics_.motion())
      {
        effort_.tolerance      = parameters.linear_solver.tolerance;
        effort_.max_iterations = parameters.linear_solver.max_iterations;
        copy(start, cells_.entries, motion_.displacement());
      }

      std::map<std::string, Direction> tool_forces(const double t)
      {
        const LatticeMotion<Real> &now = motion_;
        return outside_.tool_forces(t, now.displacement(), now.reaction());
      }

      /// Makes the step that ends at t.
      /// @throws NotConverged
      Frame advance(const double t)
      {
        const double dt = 1 / dynamics_.steps_per_second;
        Frame frame;
        frame.time       = t;
        const auto begin = Clock::now();
        if (dynamics_.frame_budget > 0)
          effort_.deadline = begin +
                             std::chrono::microseconds(std::lround(1e3 * dynamics_.frame_budget)) -
                             forces_took_;
        const auto step =
          motion_.advance(dt, outside_.force(t - (1 - middle_) * dt), outside_.imposed(t), effort_);
        const auto solved       = Clock::now();
        frame.forces            = tool_forces(t);
        const auto end          = Clock::now();
        forces_took_            = end - solved;
        frame.step_ms           = milliseconds(begin, end);
        frame.linear_iterations = step.iterations;
        frame.linear_residual   = step.residual;
        frame.way               = step.way;
        frame.kinetic_energy    = motion_.kinetic_energy();
        frame.strain_energy     = motion_.strain_energy();
        return frame;
      }

      void get(Vector &displacement) const
      {
        copy(motion_.displacement(), cells_.entries, displacement);
      }

    private:
      const DynamicsParameters &dynamics_;
      const double middle_; // where in a step loads act
      const CellLattice cells_;
      Outside<Real> outside_;
      LatticeMotion<Real> motion_;
      typename LatticeMotion<Real>::Effort effort_;
      Clock::duration forces_took_{}; // the tool's forces, in the last step
    };

    /// @throws BadInput unless there is one at least, and as many as a number can count.
    unsigned int n_steps(const Parameters &parameters)
    {
      const double end = parameters.dynamics.end_time > 0
                           ? parameters.dynamics.end_time
                           : RecordedPath(parameters.loads.path).end(),
                   n   = std::ceil(end * parameters.dynamics.steps_per_second - 1e-6);
      if (n >= 1 && n <= std::numeric_limits<unsigned int>::max())
        return n;
      std::ostringstream text;
      text << "Solver/Mode = dynamic would end at t = " << end << " s, after " << std::max(n, 0.)
           << " steps; give another 'Dynamics/End time' in s"
           << (parameters.dynamics.end_time > 0 ? "." : ", or later times in Loads/Path.");
      throw BadInput(text.str());
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
      throw BadInput(place + "has no end; give 'Dynamics/End time' in s, or a Loads/Path.");
    n_steps(parameters_);
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
    const double tolerance             = std::max<double>(parameters_.linear_solver.tolerance,
                                              10 * std::numeric_limits<Real>::epsilon());
    const unsigned int every           = parameters_.output.every;
    const unsigned int n_frames        = n_steps(parameters_);
    Steps<Real> steps(parameters_, materials_[0], *loads_, *discretization_, displacement_);
    make_folder(folder.string());
    GrowingFile frames((folder / "frames.csv").string());
    frames.add(frames_head(steps.tool_forces(0)));
    Vector moved = displacement_;
    while (motion_.n_steps < n_frames)
    {
      const unsigned int n   = motion_.n_steps + 1;
      const std::string step = "step " + std::to_string(n) + " of " + std::to_string(n_frames);
      const double t         = n / dynamics.steps_per_second;
      Frame frame;
      std::string failure;
      try
      {
        frame = steps.advance(t);
        steps.get(moved);
        failure = not_finite(frame, moved.l2_norm() / cell_size());
      }
      catch (const NotConverged &error)
      {
        failure = error.what();
      }
      catch (const InvertedPoint &) // of an invertible law, where J is no number
      {
        failure = "the deformation is no finite number";
      }
      if (!failure.empty())
      {
        if (failure.back() == '.')
          failure.pop_back();
        history_.reason = step + ", to " + in_seconds(t) + ", failed: " + failure +
                          "; the state at " + in_seconds(history_.reached) +
                          " is written; smaller loads, a slower motion or more Dynamics/Steps per "
                          "second may help";
        break;
      }
      displacement_.swap(moved);
      frames.add(frames_row(frame));
      history_.reached = t;
      history_.linear_iterations += frame.linear_iterations;
      most_linear_iterations_ = std::max(most_linear_iterations_, frame.linear_iterations);
      motion_.n_steps         = n;
      motion_.n_late += dynamics.frame_budget > 0 && frame.step_ms > dynamics.frame_budget;
      motion_.n_shortened += frame.way < 1;
      motion_.n_unsolved += frame.linear_residual > tolerance;
      motion_.largest_residual = std::max(motion_.largest_residual, frame.linear_residual);
      motion_.slowest_ms       = std::max(motion_.slowest_ms, frame.step_ms);
      motion_.kinetic_energy   = frame.kinetic_energy;
      motion_.forces           = frame.forces;
      console_.progress("  " + step + ": " + std::to_string(frame.linear_iterations) +
                        " linear iterations");
      if (every > 0 && n % every == 0)
        write_state(folder, t);
    }
    if (history_.reason.empty() && motion_.n_unsolved > 0 && dynamics.frame_budget == 0)
      history_.reason =
        unsolved_steps() + "; give more Dynamics/Steps per second, " +
        (dynamics.scheme == "Newmark" ? "'Dynamics/Scheme = implicit Euler', " : "") +
        "smaller loads or more Solver/Linear iterations";
    history_.converged = history_.reason.empty();
    say_motion();
  }

  std::string Simulation::unsolved_steps() const
  {
    std::ostringstream text;
    text << motion_.n_unsolved << " of " << motion_.n_steps
         << " steps left their linear system above Solver/Linear tolerance = "
         << parameters_.linear_solver.tolerance << ", the largest residual is "
         << std::setprecision(2) << motion_.largest_residual;
    return text.str();
  }

  void Simulation::say_motion()
  {
    std::ostringstream text;
    text << "  " << motion_.n_steps << " steps to " << in_seconds(history_.reached) << ", "
         << history_.linear_iterations << " linear iterations, the slowest step took "
         << std::setprecision(3) << motion_.slowest_ms << " ms";
    console_.say(text.str());
    if (parameters_.dynamics.frame_budget > 0 && motion_.n_unsolved > 0)
      console_.say("  " + unsolved_steps());
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
