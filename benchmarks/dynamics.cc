// SPDX-License-Identifier: LGPL-2.1-or-later
// How long a frame of a moving body takes, and how far its step is from a converged one: a liver
// held at its dome, which a tool pulls to and fro.

#include <softcell/discretization/methods.h>
#include <softcell/geometry/geometry.h>
#include <softcell/solvers/lattice_motion.h>

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <fstream>
#include <map>

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
      GeometryParameters geometry;
      geometry.type = body;
      geometry.size = Point(0.2, 0.13, 0.13);
      if (body == "liver")
      {
        geometry.type   = "image";
        geometry.file   = SOFTCELL_LIVER;
        geometry.scale  = 0.001;
        geometry.labels = {255};
      }
      std::vector<std::string> remarks;
      const auto shape = make_body(geometry, remarks);
      DiscretizationParameters parameters;
      parameters.method     = "weighted cell";
      parameters.grid.cells = {body == "liver" ? 33U : 22U};
      parameters.cut.levels = 3;
      return cell_lattice(
        *make_discretization(parameters, geometry, *shape, MPI_COMM_SELF, remarks));
    }

    template <class Real>
    LatticeMotion<Real> motion(const MotionParameters &parameters = {}) const
    {
      return {cells, material, all_held, {}, parameters};
    }

    /// The tool swings by 2 cm twice a second.
    template <class Real>
    LatticeVector<Real> imposed(const double t) const
    {
      LatticeVector<Real> u(cells.nodes);
      for (const std::size_t entry : tool)
        if (const std::size_t c = entry / cells.nodes.size(); c != 1)
          u.entries()[entry] = 0.02 * std::sin(4 * M_PI * t + c);
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

  template <class Real>
  void copy_entries(const LatticeVector<float> &from, LatticeVector<Real> &to)
  {
    std::copy(from.entries().begin(), from.entries().end(), to.entries().begin());
  }

  /// Largest distance, over some frames, of a step from one that is solved to 1e-10 in double
  /// precision from the same state, relative.
  void
  compare(benchmark::State &state, const Scene &body, const LatticeMotion<float>::Effort &effort)
  {
    LatticeMotion<float> motion     = body.motion<float>();
    LatticeMotion<double> converged = body.motion<double>();
    const auto weight               = body.weight(motion.tangent().masses());
    const auto exact_weight         = body.weight(converged.tangent().masses());
    double worst = 0, sum = 0, iterations = 0;
    constexpr int n_frames = 60, first = 30;
    for (int frame = 1; frame <= n_frames; ++frame)
    {
      if (frame > first)
      {
        copy_entries(motion.displacement(), converged.displacement());
        copy_entries(motion.velocity(), converged.velocity());
        const auto before = converged.displacement();
        converged.advance(dt, exact_weight, body.imposed<double>(frame * dt), {1e-10, 5000});
        iterations +=
          motion.advance(dt, weight, body.imposed<float>(frame * dt), effort).iterations;
        double error = 0, norm = 0;
        for (std::size_t i = 0; i < before.entries().size(); ++i)
        {
          const double exact = converged.displacement().entries()[i];
          error += std::pow(motion.displacement().entries()[i] - exact, 2);
          norm += std::pow(exact - before.entries()[i], 2);
        }
        worst = std::max(worst, std::sqrt(error / norm));
        sum += std::sqrt(error / norm);
      }
      else
        motion.advance(dt, weight, body.imposed<float>(frame * dt), effort);
    }
    state.counters["worst error"] = worst;
    state.counters["mean error"]  = sum / (n_frames - first);
    state.counters["iterations"]  = iterations / (n_frames - first);
  }

  /// Arguments: threads, tolerance in thousandths.
  void frame(benchmark::State &state, const std::string &name)
  {
    omp_set_num_threads(state.range(0));
    const Scene &body           = scene(name);
    LatticeMotion<float> motion = body.motion<float>();
    const auto weight           = body.weight(motion.tangent().masses());
    LatticeMotion<float>::Effort effort;
    effort.tolerance = 1e-3 * state.range(1);
    int n            = 0;
    double slowest   = 0;
    for (auto _ : state)
    {
      const auto imposed = body.imposed<float>(++n * dt);
      const auto begin   = LatticeMotion<float>::Clock::now();
      motion.advance(dt, weight, imposed, effort);
      const double seconds =
        std::chrono::duration<double>(LatticeMotion<float>::Clock::now() - begin).count();
      state.SetIterationTime(seconds);
      slowest = std::max(slowest, seconds);
    }
    state.counters["slowest ms"] = 1e3 * slowest;
    state.counters["cells"]      = body.cells.gauss_cells.size();
    state.counters["unknowns"]   = 3 * body.cells.entries.size();
    compare(state, body, effort);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 2);
  benchmark::Initialize(&argc, argv);
  for (const std::string body : {"box", "liver"})
    benchmark::RegisterBenchmark(("frame/" + body).c_str(),
                                 [=](benchmark::State &state) { frame(state, body); })
      ->ArgsProduct({{1, 2}, {100, 50, 10}})
      ->UseManualTime()
      ->Iterations(120)
      ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
}
