// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast the tangent of a Neo-Hookean body acts on a vector on a graphics card, and conjugate
// gradients iterate there; doc/gpu.md has what is predicted.

#include <softcell/operators/cuda_elasticity.h>
#include <softcell/operators/uniform_cells.h>
#include <softcell/solvers/cuda_cg.h>

#include <benchmark/benchmark.h>

#include <exception>

namespace
{
  using namespace softcell;

  constexpr int n_box = 69; // cells along each axis: 1.03 million unknowns

  CellLattice full_box()
  {
    CellLattice box{
      NodeLattice(std::array<int, 3>{{n_box, n_box, n_box}}), Direction(), {}, {}, {}};
    box.spacing[0] = box.spacing[1] = box.spacing[2] = 1. / n_box;
    GaussCell cell;
    cell.weights.fill(box.spacing[0] * box.spacing[1] * box.spacing[2] / 8);
    for (int k = 0; k < n_box; ++k)
      for (int j = 0; j < n_box; ++j)
        for (int i = 0; i < n_box; ++i)
        {
          cell.place = {{i, j, k}};
          box.gauss_cells.push_back(cell);
        }
    return box;
  }

  /// The tangent of the box at rest, clamped at its lower face.
  template <class Real>
  struct Problem
  {
    CudaElasticity<Real, Cuda> tangent;
    DeviceArray<Real, Cuda> x, y, b;

    explicit Problem(const CellLattice &box)
        : tangent(CellBricks<Real>(box), Material("Neo-Hookean", 5000, 0.3)),
          x(3 * box.nodes.size()),
          y(x.size()),
          b(x.size())
    {
      std::vector<unsigned char> held(box.nodes.size(), 0);
      LatticeVector<Real> load(box.nodes);
      for (int j = 0; j <= n_box; ++j)
        for (int i = 0; i <= n_box; ++i)
        {
          held[box.nodes.entry(i, j, 0)]                  = 7;
          load.component(1)[box.nodes.entry(i, j, n_box)] = 1;
        }
      tangent.set_state(x);
      tangent.hold(held);
      b.copy_from(load.entries().data());
    }
  };

  /// Waits for all kernels.
  template <class Real>
  void wait_for(const DeviceArray<Real, Cuda> &field)
  {
    Real first;
    Cuda::copy(&first, field.data(), sizeof(first));
  }

  /// Runs `work` n times between two looks at the clock.
  template <class Real, class Work>
  void measure(benchmark::State &state, const Work &work)
  {
    try
    {
      Problem<Real> problem(full_box());
      double n = 0;
      for ([[maybe_unused]] auto _ : state)
        n += work(problem);
      state.counters["unknowns/s"] = benchmark::Counter(
        n * 3 * (n_box + 1) * (n_box + 1) * (n_box + 1), benchmark::Counter::kIsRate);
    }
    catch (const std::exception &error)
    {
      state.SkipWithError(error.what());
    }
  }

  template <class Real>
  void tangent_action(benchmark::State &state)
  {
    measure<Real>(state, [](Problem<Real> &p) {
      constexpr int n = 100;
      for (int i = 0; i < n; ++i)
        p.tangent.vmult(p.y, p.b);
      wait_for(p.y);
      return n;
    });
  }

  template <class Real>
  void conjugate_gradients(benchmark::State &state)
  {
    measure<Real>(state, [](Problem<Real> &p) {
      DeviceArray<Real, Cuda> blocks(2 * p.x.size());
      p.tangent.diagonal(blocks);
      CudaCG<Real, Cuda> cg(p.x.size());
      cg.set_diagonal(blocks);
      return cg.solve([&](auto &y, const auto &x) { p.tangent.vmult(y, x); }, p.x, p.b, 1e-4, 2000);
    });
  }

  BENCHMARK_TEMPLATE(tangent_action, double)->UseRealTime();
  BENCHMARK_TEMPLATE(tangent_action, float)->UseRealTime();
  BENCHMARK_TEMPLATE(conjugate_gradients, double)->UseRealTime();
  BENCHMARK_TEMPLATE(conjugate_gradients, float)->UseRealTime();
} // namespace

BENCHMARK_MAIN();
