// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast tangents act on a vector on a graphics card, cell by cell and by rows, and conjugate
// gradients iterate there; and what the card could do at most. doc/gpu.md has what came out.

#include <softcell/operators/cuda_elasticity.h>
#include <softcell/operators/cuda_flat_elasticity.h>
#include <softcell/operators/flat_patches.h>
#include <softcell/solvers/cuda_cg.h>
#include <softcell/solvers/cuda_multigrid.h>
#include <softcell/solvers/matrix_free_solver.h>

#include "../tests/operators/lattice.h"
#include "bodies.h"
#include "cuda_peak.h"

#include <deal.II/base/mpi.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

namespace
{
  using namespace softcell;
  using benchmark::Counter;

  /// Each cell in eight, which share out what its Gauss points have.
  CellLattice refined(const CellLattice &cells)
  {
    std::array<int, 3> n;
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = 2 * cells.nodes.n_cells()[d];
    CellLattice fine{NodeLattice(n), cells.spacing / 2., {}, {}, {}};
    for (const GaussCell &cell : cells.gauss_cells)
      for (int q = 0; q < 8; ++q)
        if (cell.weights[q] > 0)
        {
          fine.gauss_cells.push_back({{{2 * cell.place[0] + q % 2, 2 * cell.place[1] + q / 2 % 2,
                                        2 * cell.place[2] + q / 4}},
                                      {}});
          fine.gauss_cells.back().weights.fill(cell.weights[q] / 8);
        }
    fine.entries = node_entries(fine);
    return fine;
  }

  /// Of about one or eight million unknowns; made once.
  const CellLattice &lattice(const std::string &body, const int millions)
  {
    static std::map<std::pair<std::string, int>, CellLattice> lattices;
    const auto known = lattices.find({body, millions});
    if (known != lattices.end())
      return known->second;
    CellLattice cells = body == "box"   ? cube_cells(millions == 1 ? 69 : 139)
                        : millions == 1 ? cells_of(liver(), 86)
                                        : refined(lattice(body, 1));
    return lattices.insert({{body, millions}, std::move(cells)}).first->second;
  }

  /// Entries of the nodes of the lowest third.
  std::vector<std::size_t> lowest(const CellLattice &cells)
  {
    int bottom = cells.nodes.n_cells()[2], top = 0;
    for (const GaussCell &cell : cells.gauss_cells)
    {
      bottom = std::min(bottom, cell.place[2]);
      top    = std::max(top, cell.place[2] + 1);
    }
    std::vector<std::size_t> entries;
    const std::size_t plane = cells.nodes.plane(), n_planes = 1 + (top - bottom) / 3;
    for (std::size_t node = bottom * plane; node < (bottom + n_planes) * plane; ++node)
      for (unsigned int c = 0; c < dim; ++c)
        entries.push_back(c * cells.nodes.size() + node);
    return entries;
  }

  /// The tangent of a body at rest whose lowest third is held, and a force across.
  template <class Real>
  struct Problem
  {
    LatticeUnknowns unknowns;
    CudaElasticity<Real, Cuda> tangent;
    DeviceArray<Real, Cuda> x, y, b;

    Problem(const CellLattice &cells, const std::string &law)
        : unknowns(cells, lowest(cells)),
          tangent(CellBricks<Real>(cells), Material(law, 5000, 0.3)),
          x(3 * cells.nodes.size()),
          y(x.size()),
          b(x.size())
    {
      std::vector<unsigned char> held(cells.nodes.size(), 7);
      LatticeVector<Real> load(cells.nodes);
      for (const std::size_t entry : unknowns.free_entries())
      {
        held[entry % held.size()] &= ~(1U << entry / held.size());
        load.entries()[entry] = entry / held.size() == 0 ? 1 : 0;
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

  /// Between two looks at the clock, so that starts and ends do not count.
  constexpr int n_runs = 100;

  Counter rate(const double n)
  {
    return {n, Counter::kIsIterationInvariantRate};
  }

  template <class Real>
  void tangent_action(benchmark::State &state,
                      const std::string &body,
                      const int millions,
                      const std::string &law)
  {
    Problem<Real> p(lattice(body, millions), law);
    p.tangent.vmult(p.y, p.b);
    wait_for(p.y);
    for (auto _ : state)
    {
      for (int i = 0; i < n_runs; ++i)
        p.tangent.vmult(p.y, p.b);
      wait_for(p.y);
    }
    const double n               = 3. * lattice(body, millions).entries.size();
    state.counters["unknowns"]   = n;
    state.counters["unknowns/s"] = rate(n_runs * n);
    state.counters["cells/s"] = rate(double(n_runs) * lattice(body, millions).gauss_cells.size());
  }

  /// Rows of weighted cells, n along each axis.
  template <class Real>
  void rows(benchmark::State &state)
  {
    const unsigned int n = 69;
    const UnitCells cells({{n, n, n}}, 2);
    const FlatPatches<Real> patches(cells, card_width);
    CudaFlatElasticity<Real, Cuda> tangent(patches.arrays(), {Material("Neo-Hookean", 5000, 0.3)});
    std::vector<Real> values(3 * cells.node_positions().size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::cos(Real(0.3) * i);
    DeviceArray<Real, Cuda> u(values.size()), x(values), y(values.size());
    tangent.set_state(u);
    for (auto _ : state)
    {
      for (int i = 0; i < n_runs; ++i)
        tangent.vmult(y, x);
      wait_for(y);
    }
    state.counters["unknowns"]   = values.size();
    state.counters["unknowns/s"] = rate(double(n_runs) * values.size());
  }

  template <class Real>
  void conjugate_gradients(benchmark::State &state, const std::string &body, const int millions)
  {
    Problem<Real> p(lattice(body, millions), "Neo-Hookean");
    DeviceArray<Real, Cuda> blocks(2 * p.x.size());
    p.tangent.diagonal(blocks);
    const InverseDiagonal<Real, Cuda> inverse(blocks, p.x.size());
    CudaCG<Real, Cuda> cg(p.x.size());
    for (auto _ : state)
      cg.iterate([&](auto &y, const auto &x) { p.tangent.vmult(y, x); },
                 [&](auto &z, const auto &r) { inverse.vmult(z, r); }, p.x, p.b, 1e-6, 300);
    const double n                 = cg.history().size();
    state.counters["iterations"]   = n;
    state.counters["iterations/s"] = rate(n);
    state.counters["unknowns/s"]   = rate(n * 3 * lattice(body, millions).entries.size());
  }

  template <class F>
  double seconds(const F &f)
  {
    const auto begin = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  /// What multigrid does in conjugate gradients of double precision with a V-cycle in single
  /// precision.
  struct Effort
  {
    unsigned int degree;
    Tangent smoother;
    double tolerance;
  };

  void multigrid(benchmark::State &state, const CellLattice &cells, const Effort &effort)
  {
    Problem<double> p(cells, "Neo-Hookean");
    std::unique_ptr<CudaMultigrid<float, Cuda>> cycle;
    state.counters["set-up, s"] = seconds([&] {
      cycle = std::make_unique<CudaMultigrid<float, Cuda>>(
        cells, Material("Neo-Hookean", 5000, 0.3), lowest(cells), effort.degree);
    });
    state.counters["state, s"]  = seconds([&] { cycle->set_state(p.x, effort.smoother); });
    state.counters["cycle, s"]  = seconds([&] {
                                   for (int i = 0; i < n_runs; ++i)
                                     cycle->vmult(p.y, p.b);
                                   wait_for(p.y);
                                 }) /
                                 n_runs;
    CudaCG<double, Cuda> cg(p.x.size());
    unsigned int n = 0;
    for (auto _ : state)
      n = cg.solve([&](auto &y, const auto &x) { p.tangent.vmult(y, x); },
                   [&](auto &z, const auto &r) { cycle->vmult(z, r); }, p.x, p.b, effort.tolerance,
                   200);
    state.counters["iterations"] = n;
    state.counters["cells"]      = cells.gauss_cells.size();
    state.counters["unknowns"]   = p.unknowns.free_entries().size();
  }

  /// The same on the host, to 1e-6.
  void multigrid_of_the_host(benchmark::State &state, const CellLattice &cells)
  {
    std::vector<std::size_t> numbers(3 * cells.nodes.size(), 3 * cells.entries.size());
    for (std::size_t node = 0; node < cells.entries.size(); ++node)
      for (unsigned int c = 0; c < dim; ++c)
        numbers[c * cells.nodes.size() + cells.entries[node]] = 3 * node + c;
    std::vector<unsigned int> held;
    for (const std::size_t entry : lowest(cells))
      if (numbers[entry] < 3 * cells.entries.size())
        held.push_back(numbers[entry]);
    LinearSolverParameters parameters;
    parameters.tolerance      = 1e-6;
    parameters.max_iterations = 200;
    const auto partitioner    = std::make_shared<Partitioner>(3 * cells.entries.size());
    Vector b(partitioner), x(partitioner);
    for (std::size_t node = 0; node < cells.entries.size(); ++node)
      b.local_element(3 * node) = 1;
    MatrixFreeSolver solver(cells, Material("Neo-Hookean", 5000, 0.3), held, parameters);
    solver.set_state(x);
    state.counters["state, s"] =
      seconds([&] { solver.set_matrix(BlockMatrix(partitioner, {}), {}, {}); });
    for (auto _ : state)
      state.counters["iterations"] = solver.solve(x, b);
    state.counters["unknowns"] = 3 * cells.entries.size() - held.size();
  }

  /// Copies 2 GiB; bytes that are read and bytes that are written.
  void copy_memory(benchmark::State &state)
  {
    DeviceArray<double, Cuda> from(1 << 28), to(from.size());
    for (auto _ : state)
    {
      for (int i = 0; i < 10; ++i)
        to.copy_from(from);
      wait_for(to);
    }
    state.counters["bytes/s"] = rate(10 * 2. * sizeof(double) * from.size());
  }

  template <class Real>
  void fused_operations(benchmark::State &state)
  {
    using Kernel                   = FusedKernel<Real>;
    constexpr std::size_t n_blocks = 1 << 14;
    DeviceArray<Real, Cuda> results(n_blocks * Kernel::n_threads);
    for (auto _ : state)
    {
      Cuda::launch(Kernel{results.data()}, n_blocks);
      wait_for(results);
    }
    state.counters["operations/s"] = rate(2. * Kernel::n_chains * Kernel::n_steps * results.size());
  }

  template <class F>
  void add(const std::string &name, const F &f)
  {
    benchmark::RegisterBenchmark(name.c_str(), f)->UseRealTime()->Unit(benchmark::kMillisecond);
  }

  /// Calls f(name, body, millions).
  template <class F>
  void for_each_body(const F &f)
  {
    std::vector<std::string> bodies{"box"};
    if (has_liver())
      bodies.emplace_back("liver");
    for (const std::string &body : bodies)
      for (const int millions : {1, 8})
        f(body + '/' + std::to_string(millions) + "e6", body, millions);
  }

  template <class Real>
  void register_all(const std::string &real)
  {
    add("fused operations/" + real, fused_operations<Real>);
    for_each_body([&](const std::string &name, const std::string &body, const int millions) {
      for (const std::string law : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
        add("tangent/" + name + '/' + law + '/' + real,
            [=](benchmark::State &state) { tangent_action<Real>(state, body, millions, law); });
      add("conjugate gradients/" + name + '/' + real,
          [=](benchmark::State &state) { conjugate_gradients<Real>(state, body, millions); });
    });
    add("tangent by rows/" + real, rows<Real>);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv);
  if (!Cuda::is_there())
  {
    std::cerr << "There is no graphics card.\n";
    return 1;
  }
  benchmark::Initialize(&argc, argv);
  add("copy", copy_memory);
  register_all<double>("double");
  register_all<float>("float");
  for_each_body([](const std::string &name, const std::string &body, const int millions) {
    add("multigrid/" + name, [=](benchmark::State &state) {
      multigrid(state, lattice(body, millions),
                {MatrixFreeSolver::smoother_degree, Tangent::exact, 1e-6});
    });
    add("multigrid of the host/" + name,
        [=](benchmark::State &state) { multigrid_of_the_host(state, lattice(body, millions)); });
  });
  if (has_liver()) // about 16 000 cells, as many as a frame may have
    add("multigrid/frame", [](benchmark::State &state) {
      multigrid(state, cells_of(liver(), 31), {1, Tangent::definite, 1e-2});
    });
  benchmark::RunSpecifiedBenchmarks();
}
