// SPDX-License-Identifier: LGPL-2.1-or-later
// How long a frame of a moving body takes, and how far its steps and the whole motion are from
// converged ones: a liver held at its dome, which hangs down suddenly and is pulled to and fro.

#include <softcell/solvers/lattice_motion.h>

#include "bodies.h"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <map>
#include <string>

namespace
{
  using namespace softcell;

  constexpr double dt = 1. / 60;
  const Material material("Neo-Hookean", 5000, 0.45, 1060);

  /// The body's cells, with the nodes that are held and those that the tool holds.
  struct Scene
  {
    explicit Scene(const std::string &body) : cells(cells_of(body))
    {
      const int top = cells.nodes.n_cells()[2], right = cells.nodes.n_cells()[0];
      for (const std::size_t node : cells.entries)
      {
        const int i = node % cells.nodes.plane() % cells.nodes.row(),
                  k = node / cells.nodes.plane();
        for (unsigned int c = 0; c < dim; ++c)
          if (k > 0.8 * top)
            held.push_back(c * cells.nodes.size() + node);
          else if (i > 0.85 * right)
            tool.push_back(c * cells.nodes.size() + node);
      }
      all_held = held;
      all_held.insert(all_held.end(), tool.begin(), tool.end());
    }

    static CellLattice cells_of(const std::string &body)
    {
      GeometryParameters box;
      box.type = "box";
      box.size = Point(0.2, 0.13, 0.13);
      return body == "liver" ? softcell::cells_of(liver(), 31, 3) : softcell::cells_of(box, 22, 3);
    }

    template <class Real>
    LatticeMotion<Real> motion(const MotionParameters &parameters = {}) const
    {
      return {cells, material, all_held, {}, parameters};
    }

    /// The tool swings by 2 cm twice a second, from 0.5 s on in full.
    template <class Real>
    LatticeVector<Real> imposed(const double t) const
    {
      const double swing = 0.01 * (1 - std::cos(M_PI * std::min(2 * t, 1.)));
      LatticeVector<Real> u(cells.nodes);
      for (const std::size_t entry : tool)
        if (const std::size_t c = entry / cells.nodes.size(); c != 1)
          u.entries()[entry] = swing * std::sin(4 * M_PI * t + c);
      return u;
    }

    template <class Real>
    LatticeVector<Real> weight(const LatticeField<Real, 1> &masses) const
    {
      LatticeVector<Real> f(cells.nodes);
      for (std::size_t i = 0; i < cells.nodes.size(); ++i)
        f.component(2)[i] = -9.81 * masses.component(0)[i];
      return f;
    }

    CellLattice cells;
    std::vector<std::size_t> held, tool, all_held;
  };

  const Scene &scene(const std::string &body)
  {
    static std::map<std::string, Scene> scenes;
    return scenes.try_emplace(body, body).first->second;
  }

  using Motion = LatticeMotion<float>;
  using Exact  = LatticeMotion<double>;

  constexpr unsigned int n_frames = 120, // 2 s
    every                         = 10;  // frames between those that are compared

  void converged_step(const Scene &body, Exact &motion, const double t)
  {
    motion.advance(dt, body.weight(motion.tangent().masses()), body.imposed<double>(t),
                   {1e-9, 2000});
  }

  /// Errors, relative to the values: in the body's L2 norm, by lumped masses, and over all nodes
  /// alike, also those of cells that the body hardly fills.
  struct Errors
  {
    double in_body, at_nodes;

    Errors(const LatticeVector<float> &a,
           const LatticeVector<double> &b,
           const LatticeField<double, 1> &masses)
    {
      double sums[4] = {};
      for (unsigned int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < b.lattice().size(); ++i)
        {
          const double value = b.component(c)[i], error = a.component(c)[i] - value,
                       mass = masses.component(0)[i];
          sums[0] += mass * error * error;
          sums[1] += mass * value * value;
          sums[2] += error * error;
          sums[3] += value * value;
        }
      in_body  = std::sqrt(sums[0] / sums[1]);
      at_nodes = std::sqrt(sums[2] / sums[3]);
    }
  };

  /// 2 s of motion. Time is that of all frames over their number. `step` has the errors of single
  /// steps against converged ones from the same state, in the velocity at their end, which is that
  /// in the displacement's change; `motion` those of the displacement against that of a motion of
  /// converged steps.
  /// Arguments: threads, and iterations of a frame.
  void frames(benchmark::State &state, const std::string &name)
  {
    if (name == "liver" && !has_liver())
    {
      state.SkipWithError("scripts/fetch-liver has not been run");
      return;
    }
    omp_set_num_threads(state.range(0));
    const Scene &body = scene(name);
    Motion::Effort effort;
    effort.tolerance      = 1e-6;
    effort.max_iterations = state.range(1);
    Exact step = body.motion<double>(), whole = body.motion<double>();
    const auto &masses = step.tangent().masses();
    double slowest = 0, worst_step = 0, worst_at_nodes = 0, worst_motion = 0;
    for (auto _ : state)
    {
      Motion motion     = body.motion<float>();
      const auto weight = body.weight(motion.tangent().masses());
      double total      = 0;
      for (unsigned int n = 1; n <= n_frames; ++n)
      {
        const auto imposed = body.imposed<float>(n * dt);
        const auto u       = std::as_const(motion).displacement();
        const auto v       = motion.velocity();
        const auto begin   = Motion::Clock::now();
        motion.advance(dt, weight, imposed, effort);
        const double seconds = std::chrono::duration<double>(Motion::Clock::now() - begin).count();
        total += seconds;
        slowest = std::max(slowest, n > 1 ? seconds : 0); // the first one makes the blocks
        converged_step(body, whole, n * dt);
        if (n % every != 0)
          continue;
        std::copy(u.entries().begin(), u.entries().end(), step.displacement().entries().begin());
        std::copy(v.entries().begin(), v.entries().end(), step.velocity().entries().begin());
        converged_step(body, step, n * dt);
        const Errors in_step(motion.velocity(), step.velocity(), masses),
          in_motion(std::as_const(motion).displacement(), std::as_const(whole).displacement(),
                    masses);
        worst_step     = std::max(worst_step, in_step.in_body);
        worst_at_nodes = std::max(worst_at_nodes, in_step.at_nodes);
        worst_motion   = std::max(worst_motion, in_motion.in_body);
      }
      state.SetIterationTime(total / n_frames);
    }
    state.counters["slowest ms"]     = 1e3 * slowest;
    state.counters["step"]           = worst_step;
    state.counters["step, at nodes"] = worst_at_nodes;
    state.counters["motion"]         = worst_motion;
    state.counters["cells"]          = body.cells.gauss_cells.size();
    state.counters["unknowns"]       = 3 * body.cells.entries.size() - body.all_held.size();
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 2);
  benchmark::Initialize(&argc, argv);
  for (const std::string body : {"box", "liver"})
    benchmark::RegisterBenchmark(("frame/" + body).c_str(),
                                 [=](benchmark::State &state) { frames(state, body); })
      ->ArgNames({"threads", "iterations"})
      ->ArgsProduct({{1, 2}, {3, 4}})
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
}
