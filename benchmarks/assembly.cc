// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast the tangent is assembled: congruent cells of eight points, which is what weighted cells
// are, and cells of hundreds of points with their own shapes, which is what finite cells are.

#include <softcell/operators/elasticity.h>

#include "../tests/operators/lattice.h"

#include <deal.II/base/mpi.h>

#include <benchmark/benchmark.h>

namespace
{
  using namespace softcell;

  Vector bent(const UnitCells &lattice)
  {
    Vector u = lattice.make_vector();
    for (unsigned int node = 0; node < lattice.node_positions().size(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        u.local_element(3 * node + c) =
          0.05 * std::sin(lattice.node_positions()[node] * Point(0.3, 0.2 * c, 0.1));
    return u;
  }

  void report(benchmark::State &state, const UnitCells &lattice, const unsigned int n_points)
  {
    const double n_cells       = lattice.n_patches();
    state.counters["cells/s"]  = {n_cells, benchmark::Counter::kIsIterationInvariantRate};
    state.counters["points/s"] = {n_cells * n_points,
                                  benchmark::Counter::kIsIterationInvariantRate};
  }

  /// Arguments: cells per axis, Gauss points per axis, LatticePatches.
  void tangent(benchmark::State &state, const char *model, const bool has_projection = false)
  {
    const unsigned int n        = state.range(0),
                       n_points = state.range(1) * state.range(1) * state.range(1);
    UnitCells lattice({{n, n, n}}, state.range(1), static_cast<LatticePatches>(state.range(2)));
    for (UnitCells::Cell &cell : lattice.cells)
      for (unsigned int q = 0; q < n_points; ++q)
        cell.weights[q] *= 0.1 + 0.9 * q / n_points;
    const Elasticity elasticity(lattice, {Material(model, 5000, 0.3)}, has_projection);
    const Vector u = bent(lattice);
    BlockMatrix K(lattice.partitioner(), elasticity.couplings());
    for (auto _ : state)
    {
      K.set_zero();
      elasticity.add_tangent(u, K);
    }
    report(state, lattice, n_points);
  }

  void residual(benchmark::State &state, const char *model)
  {
    const unsigned int n = state.range(0);
    const UnitCells lattice({{n, n, n}}, 2);
    const Elasticity elasticity(lattice, {Material(model, 5000, 0.3)});
    const Vector u = bent(lattice);
    Vector r       = lattice.make_vector();
    for (auto _ : state)
      elasticity.add_residual(u, r);
    report(state, lattice, 8);
  }

  constexpr int congruent  = static_cast<int>(LatticePatches::congruent);
  constexpr int own_tables = static_cast<int>(LatticePatches::own_tables);

  BENCHMARK_CAPTURE(tangent, weighted_cell_neo_hookean, "Neo-Hookean")
    ->Args({10, 2, congruent})
    ->Args({30, 2, congruent})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, weighted_cell_projected, "Neo-Hookean", true)
    ->Args({30, 2, congruent})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, finite_cell_neo_hookean, "Neo-Hookean")
    ->Args({5, 8, own_tables})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, finite_cell_projected, "Neo-Hookean", true)
    ->Args({5, 8, own_tables})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(tangent, weighted_cell_saint_venant_kirchhoff, "Saint-Venant-Kirchhoff")
    ->Args({30, 2, congruent})
    ->Unit(benchmark::kMillisecond);
  BENCHMARK_CAPTURE(residual, weighted_cell_neo_hookean, "Neo-Hookean")
    ->Args({30})
    ->Unit(benchmark::kMillisecond);
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
