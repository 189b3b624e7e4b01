// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast the tangent of a bent cylinder is assembled with each cut-cell rule and level,
// quadrature and addition to the sparse matrix included (Brunet fig. 4.7), and how fast the cells
// are set up.

#include <softcell/discretization/immersed.h>
#include <softcell/geometry/geometry.h>
#include <softcell/operators/elasticity.h>

#include <deal.II/base/mpi.h>

#include <benchmark/benchmark.h>

namespace
{
  using namespace softcell;

  std::unique_ptr<Body> cylinder()
  {
    GeometryParameters geometry;
    geometry.type   = "cylinder";
    geometry.radius = 0.05;
    geometry.length = 0.6;
    std::vector<std::string> remarks;
    return make_body(geometry, remarks);
  }

  /// @param state with the arguments: cells across, cut levels.
  std::unique_ptr<Immersed>
  discretization_of(const char *rule, const benchmark::State &state, const Body &body)
  {
    GridParameters grid;
    grid.cells = {static_cast<unsigned int>(state.range(0))};
    CutParameters cut;
    cut.levels = state.range(1);
    return std::make_unique<Immersed>(rule, 1, grid, cut, body, MPI_COMM_SELF);
  }

  void setup(benchmark::State &state, const char *rule)
  {
    const auto body = cylinder();
    Size size;
    for (auto _ : state)
      size = discretization_of(rule, state, *body)->size();
    state.counters["cut cells/s"] = {double(size.cut_cells),
                                     benchmark::Counter::kIsIterationInvariantRate};
  }

  void tangent(benchmark::State &state, const char *rule)
  {
    const auto body           = cylinder();
    const auto discretization = discretization_of(rule, state, *body);
    const Elasticity elasticity(*discretization, {Material("Neo-Hookean", 5000, 0.3)});
    BlockMatrix K(discretization->partitioner(), elasticity.couplings());

    Vector u = discretization->make_vector();
    for (unsigned int node = 0; node < discretization->node_positions().size(); ++node)
    {
      const double z                = discretization->node_positions()[node][2];
      u.local_element(3 * node + 1) = -z * z;
    }
    for (auto _ : state)
    {
      K.set_zero();
      elasticity.add_tangent(u, K);
    }
    const Size size           = discretization->size();
    state.counters["cells/s"] = {double(size.cells), benchmark::Counter::kIsIterationInvariantRate};
    state.counters["points/s"] = {double(size.integration_points),
                                  benchmark::Counter::kIsIterationInvariantRate};
  }

  BENCHMARK_CAPTURE(tangent, weighted_cell, "weighted cell")
    ->ArgsProduct({{8, 16, 24}, {0, 1, 2, 3, 4}})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, moment_fitting, "moment fitting")
    ->ArgsProduct({{8, 16, 24}, {1, 2, 3, 4}})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, finite_cell, "finite cell")
    ->ArgsProduct({{8, 16}, {1, 2, 3, 4}})
    ->Unit(benchmark::kMillisecond);

  BENCHMARK_CAPTURE(setup, weighted_cell, "weighted cell")
    ->ArgsProduct({{8, 16}, {3, 4}})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(setup, moment_fitting, "moment fitting")
    ->ArgsProduct({{8, 16}, {3, 4}})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(setup, finite_cell, "finite cell")
    ->ArgsProduct({{8, 16}, {3, 4}})
    ->Unit(benchmark::kMillisecond);
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
