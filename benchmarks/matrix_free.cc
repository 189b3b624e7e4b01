// SPDX-License-Identifier: LGPL-2.1-or-later
// How fast the tangent of a Neo-Hookean body acts on a vector: without a matrix on full and on cut
// cells, by Trilinos with the assembled matrix, and by deal.II's MatrixFree; and what the machine
// could do at most. Threads share the rows of Trilinos' matrix as ranks would, without messages.

#include <softcell/operators/elasticity.h>
#include <softcell/operators/matrix_free_elasticity.h>

#include "../source/operators/cell_kernels.h"
#include "../tests/operators/lattice.h"
#include "bodies.h"

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <deal.II/lac/affine_constraints.h>

#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/matrix_free.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_SerialComm.h>
#include <Epetra_Vector.h>
#include <Teuchos_StackedTimer.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <benchmark/benchmark.h>
#include <omp.h>

#include <chrono>
#include <cmath>
#include <experimental/simd>
#include <functional>
#include <map>

namespace
{
  using namespace softcell;
  using benchmark::Counter;

  constexpr unsigned int n_box = 69; // cells along each axis: 1.03 million unknowns
  const Material material("Neo-Hookean", 5000, 0.3);

  template <class Real>
  using Simd = std::experimental::native_simd<Real>;

  double seconds(const std::function<void()> &f)
  {
    const auto begin = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  /// The shortest of several times.
  double least_seconds(const std::function<void()> &f)
  {
    double least = seconds(f);
    for (int i = 0; i < 9; ++i)
      least = std::min(least, seconds(f));
    return least;
  }

  /// Bytes per second of a = b + 3 c (the STREAM triad), with the read of a before it is written.
  double bytes_per_second()
  {
    const std::size_t n = 20000000;
    std::vector<double> a(n), b(n, 1.), c(n, 2.);
    return 32. * n / least_seconds([&] {
#pragma omp parallel for
             for (std::size_t i = 0; i < n; ++i)
               a[i] = b[i] + 3 * c[i];
             benchmark::ClobberMemory();
           });
  }

  /// Multiplications and additions per second, fused and in registers.
  template <class Real>
  double operations_per_second()
  {
    constexpr int n = 2000000, n_chains = 12;
    return 2. * n * n_chains * Simd<Real>::size() * omp_get_max_threads() / least_seconds([&] {
#pragma omp parallel
             {
               const Simd<Real> a(Real(0.999)), b(Real(0.001));
               Simd<Real> x[n_chains] = {};
               for (int i = 0; i < n; ++i)
#pragma GCC unroll 12
                 for (Simd<Real> &chain : x)
                   chain = a * chain + b;
               for (Simd<Real> &chain : x)
                 benchmark::DoNotOptimize(chain);
             }
           });
  }

  /// A number that counts what is done with it; a multiplication and an addition count as two. What
  /// is done with constants alone is done once for all cells, and counts nothing.
  struct Counted
  {
    static inline unsigned long n_operations = 0;
    double value                             = 0;
    bool is_constant                         = false;

    constexpr Counted() = default;
    template <class Number>
    constexpr Counted(const Number v) : value(v), is_constant(true)
    {
    }
    static Counted counted(const double value, const Counted a, const Counted b)
    {
      Counted result(value);
      result.is_constant = a.is_constant && b.is_constant;
      n_operations += result.is_constant ? 0 : 1;
      return result;
    }
    friend Counted operator+(const Counted a, const Counted b)
    {
      return counted(a.value + b.value, a, b);
    }
    friend Counted operator-(const Counted a, const Counted b)
    {
      return counted(a.value - b.value, a, b);
    }
    friend Counted operator*(const Counted a, const Counted b)
    {
      return counted(a.value * b.value, a, b);
    }
    friend Counted operator/(const Counted a, const Counted b)
    {
      return counted(a.value / b.value, a, b);
    }
    Counted operator-() const
    {
      Counted result     = -value;
      result.is_constant = is_constant;
      return result;
    }
    Counted &operator+=(const Counted other)
    {
      return *this = *this + other;
    }
    Counted &operator-=(const Counted other)
    {
      return *this = *this - other;
    }
    Counted &operator*=(const Counted other)
    {
      return *this = *this * other;
    }
  };

  /// One full cell for the kernels.
  struct CountedCell
  {
    using Number    = Counted;
    using Gradients = GaussGradients<Counted, Counted>;

    void gather(const Counted *const field, Corners<Counted> &v) const
    {
      std::copy_n(field, 8, v);
    }
    void add(const Corners<Counted> &v, Counted *const field) const
    {
      for (int i = 0; i < 8; ++i)
        field[i] += v[i];
    }
    template <class F>
    void for_each_point(const F &f) const
    {
      for (int q = 0; q < 8; ++q)
        f(GaussPoint<Counted>{q}, q, Counted(1));
    }
    static void reset_where_empty(const Counted &, Matrix3<Counted> &) {}
    static Counted load(const Counted *const numbers, const std::size_t number)
    {
      return numbers[number];
    }
  };

  /// What the tangent of one full cell needs.
  double operations_per_cell()
  {
    Counted u[3][8], x[3][8], y[3][8], pressures[8];
    const CellGeometry<Counted> geometry{{}, 1, {1, 1, 1}};
    Counted::n_operations = 0;
    add_tangent_action(
      CountedCell(), NeoHookean<Counted>{1, 1}, geometry,
      Components<const Counted>{{u[0], u[1], u[2]}}, PointModuli<const Counted>{pressures, nullptr},
      Components<const Counted>{{x[0], x[1], x[2]}}, Components<Counted>{{y[0], y[1], y[2]}});
    return Counted::n_operations;
  }

  /// Unknowns per second that memory and arithmetic allow at most, with the present threads.
  template <class Real>
  double roofline(const double operations, const double bytes)
  {
    static std::map<int, std::pair<double, double>> machine; // by threads
    const auto [entry, is_new] = machine.insert({omp_get_max_threads(), {}});
    if (is_new)
      entry->second = {operations_per_second<Real>(), bytes_per_second()};
    return 1 / std::max(operations / entry->second.first, bytes / entry->second.second);
  }

  void report(benchmark::State &state, const double n_unknowns, const double n_cells)
  {
    state.counters["unknowns/s"] = {n_unknowns, Counter::kIsIterationInvariantRate};
    state.counters["cells/s"]    = {n_cells, Counter::kIsIterationInvariantRate};
    state.counters["unknowns"]   = n_unknowns;
  }

  const CellLattice &lattice(const std::string &body)
  {
    static std::map<std::string, CellLattice> lattices; // made once
    const auto known = lattices.find(body);
    if (known != lattices.end())
      return known->second;
    GeometryParameters sphere;
    sphere.type       = "sphere";
    CellLattice cells = body == "box"      ? cube_cells(n_box)
                        : body == "liver"  ? cells_of(liver(), 88)
                        : body == "sphere" ? cells_of(sphere, 86)
                                           : cells_of(sphere, 40, 2, body);
    return lattices.insert({body, std::move(cells)}).first->second;
  }

  /// Argument: threads.
  template <class Real>
  void matrix_free(benchmark::State &state, const std::string &body)
  {
    if (body == "liver" && !has_liver())
    {
      state.SkipWithError("scripts/fetch-liver has not been run");
      return;
    }
    omp_set_num_threads(state.range(0));
    const CellLattice &all = lattice(body);
    const UniformCells<Real> cells(all);
    MatrixFreeElasticity<Real> tangent(cells, material);
    LatticeVector<Real> u(all.nodes), x(all.nodes), y(all.nodes);
    for (const std::size_t entry : all.entries)
      for (unsigned int c = 0; c < 3; ++c)
      {
        u.component(c)[entry] = 0.05 * all.spacing[0] * std::sin(0.1 * entry + c);
        x.component(c)[entry] = std::cos(0.3 * entry + c);
      }
    tangent.set_state(u);
    for (auto _ : state)
      tangent.vmult(y, x);

    const double n_unknowns = 3. * all.entries.size(),
                 n_cells    = all.gauss_cells.size() + all.point_cells.size();
    report(state, n_unknowns, n_cells);
    state.counters["filled lanes"] = n_cells * 8 / (cells.n_point_packs() * Simd<Real>::size());
    if (body == "box")
    {
      // u and x are read and y is read and written once, and the cells' pressures
      const double operations              = operations_per_cell() * n_cells / n_unknowns,
                   bytes                   = (4 + 8 * n_cells / n_unknowns) * sizeof(Real);
      state.counters["operations/unknown"] = operations;
      state.counters["bytes/unknown"]      = bytes;
      state.counters["roofline"]           = roofline<Real>(operations, bytes);
    }
  }

  /// Rows of the assembled tangent of the box in two halves.
  class TrilinosTangent
  {
  public:
    TrilinosTangent()
    {
      const UnitCells cells({{n_box, n_box, n_box}}, 2);
      const Elasticity elasticity(cells, {material});
      Vector u = cells.make_vector();
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        u.local_element(i) = 0.05 * std::sin(0.1 * i);
      BlockMatrix K(cells.partitioner(), elasticity.couplings());
      elasticity.add_tangent(u, K);
      K.compress();
      n_unknowns        = u.size();
      const int n_nodes = n_unknowns / 3;
      for (const auto &[begin, end] : {std::pair(0, n_nodes / 2), std::pair(n_nodes / 2, n_nodes)})
        halves.push_back(std::make_unique<Half>(K, begin, end, n_unknowns));
    }

    struct Half
    {
      Half(const BlockMatrix &K, const int begin, const int end, const int n_columns)
          : rows(3 * (end - begin), 0, communicator),
            columns(n_columns, 0, communicator),
            matrix(::Copy, rows, columns, row_lengths(K, begin, end).data(), true),
            x(columns),
            y(rows)
      {
        std::vector<int> indices;
        for (int node = begin; node < end; ++node)
        {
          const std::size_t first = K.row_start()[node], last = K.row_start()[node + 1];
          indices.clear();
          for (std::size_t k = first; k < last; ++k)
            for (unsigned int c = 0; c < 3; ++c)
              indices.push_back(3 * K.columns()[k] + c);
          for (unsigned int a = 0; a < 3; ++a)
            matrix.InsertMyValues(3 * (node - begin) + a, indices.size(),
                                  K.values().data() + 9 * first + a * indices.size(),
                                  indices.data());
        }
        matrix.FillComplete(columns, rows);
        matrix.OptimizeStorage();
        x.PutScalar(1);
      }

      static std::vector<int> row_lengths(const BlockMatrix &K, const int begin, const int end)
      {
        std::vector<int> lengths;
        for (int node = begin; node < end; ++node)
          lengths.insert(lengths.end(), 3, 3 * (K.row_start()[node + 1] - K.row_start()[node]));
        return lengths;
      }

      Epetra_SerialComm communicator;
      Epetra_Map rows, columns;
      Epetra_CrsMatrix matrix;
      Epetra_Vector x, y;
    };
    std::vector<std::unique_ptr<Half>> halves;
    unsigned int n_unknowns;
  };

  void trilinos(benchmark::State &state)
  {
    static TrilinosTangent tangent;                       // assembled once
    Teuchos::TimeMonitor::setStackedTimer(Teuchos::null); // it bears no two threads
    omp_set_num_threads(state.range(0));
    for (auto _ : state)
#pragma omp parallel for
      for (int half = 0; half < 2; ++half)
        tangent.halves[half]->matrix.Multiply(false, tangent.halves[half]->x,
                                              tangent.halves[half]->y);
    report(state, tangent.n_unknowns, n_box * n_box * n_box);
  }

  /// With F^-T and mu - lambda ln J kept at each point.
  template <class Real>
  void deal_ii(benchmark::State &state)
  {
    using Number = dealii::VectorizedArray<Real>;
    using Field  = dealii::LinearAlgebra::distributed::Vector<Real>;
    dealii::MultithreadInfo::set_thread_limit(state.range(0));
    dealii::Triangulation<3> triangulation;
    dealii::GridGenerator::subdivided_hyper_cube(triangulation, n_box);
    dealii::DoFHandler<3> dofs(triangulation);
    dofs.distribute_dofs(dealii::FESystem<3>(dealii::FE_Q<3>(1), 3));
    typename dealii::MatrixFree<3, Real>::AdditionalData data;
    data.mapping_update_flags = dealii::update_gradients;
    dealii::MatrixFree<3, Real> matrix_free;
    matrix_free.reinit(dealii::MappingQ1<3>(), dofs, dealii::AffineConstraints<double>(),
                       dealii::QGauss<1>(2), data);
    Field x, y;
    matrix_free.initialize_dof_vector(x);
    matrix_free.initialize_dof_vector(y);
    x = 1;

    const auto law               = material.visit([](const auto &l) {
      return NeoHookean<Real>{Real(l.lambda), Real(l.mu)};
    });
    const unsigned int n_batches = matrix_free.n_cell_batches();
    dealii::AlignedVector<dealii::Tensor<2, 3, Number>> F_inv_T(8 * n_batches);
    for (auto &F : F_inv_T)
      for (unsigned int c = 0; c < 3; ++c)
        F[c][c] = Number(Real(0.9));
    dealii::AlignedVector<Number> factors(8 * n_batches, Number(law.mu));
    for (auto _ : state)
      matrix_free.template cell_loop<Field, Field>(
        [&](const auto &cells, Field &to, const Field &from, const auto &range) {
          dealii::FEEvaluation<3, 1, 2, 3, Real> evaluation(cells);
          for (unsigned int cell = range.first; cell < range.second; ++cell)
          {
            evaluation.reinit(cell);
            evaluation.gather_evaluate(from, dealii::EvaluationFlags::gradients);
            for (unsigned int q = 0; q < 8; ++q)
            {
              const auto &I           = F_inv_T[8 * cell + q];
              const auto dF           = evaluation.get_gradient(q);
              const Number divergence = law.lambda * dealii::scalar_product(I, dF);
              evaluation.submit_gradient(
                law.mu * dF + factors[8 * cell + q] * (I * transpose(dF) * I) + divergence * I, q);
            }
            evaluation.integrate_scatter(dealii::EvaluationFlags::gradients, to);
          }
        },
        y, x, true);
    report(state, dofs.n_dofs(), n_box * n_box * n_box);
  }

  template <class Real>
  void register_all(const std::string &real)
  {
    const auto add = [&](const std::string &name, const auto &f) {
      benchmark::RegisterBenchmark((name + '/' + real).c_str(), f)
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
    };
    for (const std::string body : {"box", "sphere", "liver", "moment fitting"})
      add("matrix free/" + body, [=](benchmark::State &state) { matrix_free<Real>(state, body); });
    if (real == "double")
      add("Trilinos", trilinos);
    add("deal.II", deal_ii<Real>);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 2);
  benchmark::Initialize(&argc, argv);
  register_all<double>("double");
  register_all<float>("float");
  benchmark::RunSpecifiedBenchmarks();
}
