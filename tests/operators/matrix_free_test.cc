// SPDX-License-Identifier: LGPL-2.1-or-later
// The matrix-free operator against the assembled one.

#include <softcell/operators/matrix_free_elasticity.h>

#include "matrix_free_problems.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

#include <omp.h>

#include <cmath>
#include <experimental/simd>

namespace
{
  using namespace softcell;

  /// The largest differences from Elasticity, relative to the largest values there.
  template <class Real>
  void expect_agreement(const Discretization &discretization,
                        const Material &material,
                        const double bound)
  {
    const Vector u = wavy(discretization, 0.03, 2), x = wavy(discretization, 1, 7);
    const Elasticity elasticity(discretization, {material});
    const CellLattice lattice = cell_lattice(discretization);
    const UniformCells<Real> cells(lattice);
    MatrixFreeElasticity<Real> matrix_free(cells, material);
    LatticeVector<Real> U(lattice.nodes), X(lattice.nodes), Y(lattice.nodes);
    copy(u, lattice.entries, U);
    copy(x, lattice.entries, X);
    Vector assembled = discretization.make_vector(), y = assembled;

    EXPECT_NEAR(matrix_free.energy(U) / elasticity.energy(u), 1, bound);
    EXPECT_NEAR(matrix_free.min_jacobian(U), elasticity.min_jacobian(u), bound);

    elasticity.add_residual(u, assembled);
    matrix_free.residual(U, Y);
    copy(Y, lattice.entries, y);
    EXPECT_LT(relative_difference(y, assembled), bound);

    BlockMatrix K(discretization.partitioner(), elasticity.couplings());
    elasticity.add_tangent(u, K);
    K.compress();
    K.vmult(assembled, x);
    matrix_free.set_state(U);
    matrix_free.vmult(Y, X);
    copy(Y, lattice.entries, y);
    EXPECT_LT(relative_difference(y, assembled), bound);

    // entries that belong to no unknown stay 0
    Real sum = 0;
    for (const Real entry : Y.entries())
      sum += std::abs(entry);
    EXPECT_NEAR(sum / y.l1_norm(), 1, bound);

    LatticeBlocks<Real> blocks(lattice.nodes);
    matrix_free.diagonal(blocks);
    expect_diagonal_blocks(K, bound, [&](const unsigned int node, const int a, const int b) {
      return blocks.component(a == b ? a : 6 - a - b)[lattice.entries[node]];
    });
  }

  TEST(MatrixFreeElasticity, IsTheAssembledOneOnCutCells)
  {
    for (const std::string type : {"sphere", "cylinder", "box"})
      for (const std::string method : {"weighted cell", "moment fitting", "sparse grid"})
      {
        const Problem p = problem(type, method, 5);
        for (const std::string &model : all_laws)
        {
          SCOPED_TRACE(type + ' ' + method + ' ' + model);
          const Material material(model, 5000, 0.3);
          expect_agreement<double>(*p.discretization, material, 1e-12);
          expect_agreement<float>(*p.discretization, material, 1e-5);
        }
      }
  }

  // Each row is a cell longer than a pack; two such cells share a pack.
  TEST(UniformCells, ShareWhatIsLeftOfRows)
  {
    const int W = std::experimental::native_simd<double>::size();
    CellLattice lattice{
      NodeLattice(std::array<int, 3>{{W + 1, 5, 2}}), Direction({1, 1, 1}), {}, {}, {}};
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i <= W; ++i)
          lattice.gauss_cells.push_back({{{i, j, k}}, {}});
    EXPECT_EQ(UniformCells<double>(lattice).n_point_packs(), 8 * 2 * (5 + 3));
  }

  // Rows of packs of full cells, for doubles and for floats, and what is left of them in packs of
  // two rows; layers are more than one slab.
  TEST(MatrixFreeElasticity, IsTheAssembledOneOnLongRows)
  {
    const Material material("Neo-Hookean", 5000, 0.3);
    for (const auto &[type, cells] : {std::pair("box", 18), std::pair("cylinder", 25)})
    {
      SCOPED_TRACE(type);
      const Problem p = problem(type, "weighted cell", cells);
      expect_agreement<double>(*p.discretization, material, 1e-12);
      expect_agreement<float>(*p.discretization, material, 1e-5);
    }
  }

  TEST(MatrixFreeElasticity, IsTheSameForAnyNumberOfThreads)
  {
    const Problem p           = problem("sphere", "moment fitting", 17);
    const CellLattice lattice = cell_lattice(*p.discretization);
    const UniformCells<double> cells(lattice);
    LatticeVector<double> u(lattice.nodes), x(lattice.nodes), alone(lattice.nodes);
    copy(wavy(*p.discretization, 0.02, 2), lattice.entries, u);
    copy(wavy(*p.discretization, 1, 7), lattice.entries, x);
    const int n_threads = omp_get_max_threads();
    double energy_alone = 0;
    for (const int n : {1, 2, 5})
    {
      omp_set_num_threads(n);
      MatrixFreeElasticity<double> matrix_free(cells, Material("Neo-Hookean", 5000, 0.3));
      LatticeVector<double> y(lattice.nodes);
      matrix_free.set_state(u);
      matrix_free.vmult(y, x);
      if (n == 1)
      {
        alone        = y;
        energy_alone = matrix_free.energy(u);
      }
      EXPECT_TRUE(std::equal(y.entries().begin(), y.entries().end(), alone.entries().begin()));
      EXPECT_EQ(matrix_free.energy(u), energy_alone);
    }
    omp_set_num_threads(n_threads);
  }

  TEST(MatrixFreeElasticity, IsTheAssembledOneOnALiver)
  {
    for (const std::string rule : {"weighted cell", "moment fitting"})
    {
      const Problem p = liver(rule, 8);
      if (!p.discretization)
        GTEST_SKIP() << "The liver's image is missing.";
      const Material material("Neo-Hookean", 5000, 0.45);
      expect_agreement<double>(*p.discretization, material, 1e-12);
      expect_agreement<float>(*p.discretization, material, 1e-5);
    }
  }

  /// dF : dP of a cell with the same F everywhere.
  template <class Real>
  double energy_of(const Matrix3<Real> &dF,
                   const Matrix3<Real> &F,
                   const Material &material,
                   const Tangent tangent)
  {
    CellLattice cell{NodeLattice(std::array<int, 3>{{1, 1, 1}}), Direction({1, 1, 1}), {}, {}, {}};
    cell.gauss_cells.push_back({{{0, 0, 0}}, {}});
    cell.gauss_cells[0].weights.fill(0.125);
    const UniformCells<Real> cells(cell);
    MatrixFreeElasticity<Real> elasticity(cells, material);
    LatticeVector<Real> u(cell.nodes), x(cell.nodes), Kx(cell.nodes);
    for (int v = 0; v < 8; ++v)
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d)
          if ((v >> d & 1) != 0)
          {
            const std::size_t entry = cell.nodes.entry(v % 2, v / 2 % 2, v / 4);
            u.component(c)[entry] += F(c, d) - (c == d ? 1 : 0);
            x.component(c)[entry] += dF(c, d);
          }
    elasticity.set_state(u, tangent);
    elasticity.vmult(Kx, x);
    double sum = 0;
    for (std::size_t i = 0; i < x.entries().size(); ++i)
      sum += double(x.entries()[i]) * Kx.entries()[i];
    return sum;
  }

  const Material soft("Neo-Hookean", 2.9, 0.45); // mu = 1

  /// The energy of the softest change of a cell with stretches s_1 < s_2 < s_3 between two turns,
  /// A F with A = [[0, -s_1], [s_2, 0]] in their axes, in units of mu s_1^2 s_2^2. It is
  /// 2 - 2 f / (s_1 s_2), with f mu in place of mu - lambda ln J.
  template <class Real>
  double softest_energy(const std::array<Real, 3> &s, const Tangent tangent)
  {
    const Matrix3<Real> S{{s[0], 0, 0, 0, s[1], 0, 0, 0, s[2]}},
      A{{0, -s[0], 0, s[1], 0, 0, 0, 0, 0}},
      R{{Real(0.36), Real(0.48), Real(-0.8), Real(-0.8), Real(0.6), 0, Real(0.48), Real(0.64),
         Real(0.6)}};
    return energy_of(R * A * S * transpose(R * R), R * S * transpose(R * R), soft, tangent) /
           (s[0] * s[0] * s[1] * s[1]);
  }

  // Under a tension from all sides f is negative. It makes the exact tangent indefinite, and
  // lambda + f - f_0 negative.
  TEST(MatrixFreeElasticity, DefiniteTangentIsDefiniteUnderTension)
  {
    const Matrix3<double> F{{1.7, 0, 0, 0, 1.7, 0, 0, 0, 1.7}},
      longer{{1.7, 0, 0, 0, -1.7, 0, 0, 0, 0}};
    EXPECT_LT(energy_of(longer, F, soft, Tangent::exact), -1);
    EXPECT_GT(energy_of(longer, F, soft, Tangent::definite), -1e-9);
    EXPECT_GT(energy_of(F, F, soft, Tangent::definite), -1e-9);
  }

  // 0 would be left if no more was left out than must be; the bound of s_1 s_2 is 0.86 of it at
  // least.
  TEST(MatrixFreeElasticity, DefiniteTangentLeavesOutLittleMoreThanItMust)
  {
    const std::array<double, 3> squeezed{{0.6, 0.9, 1.6}}, flat{{0.002, 1, 1.2}};
    const std::array<float, 3> float_flat{{0.002F, 1, 1.2F}};
    for (const auto &s : {squeezed, flat})
    {
      EXPECT_LT(softest_energy(s, Tangent::exact), -1);
      EXPECT_GT(softest_energy(s, Tangent::definite), -1e-9);
      EXPECT_LT(softest_energy(s, Tangent::definite), 0.28);
    }
    // J is good to 1e-4 there
    EXPECT_GT(softest_energy(float_flat, Tangent::definite), -1e-3);
    EXPECT_LT(softest_energy(float_flat, Tangent::definite), 0.28);
  }

  // Shears of both signs, from inside out to where the law is Neo-Hookean.
  TEST(MatrixFreeElasticity, DefiniteTangentIsDefiniteWhereTheLawIsContinued)
  {
    for (const double s : {-1., -0.3, -0.01, 0., 0.1, 0.2, 0.3, 0.6})
      for (const double sign : {-1, 1})
      {
        const Matrix3<double> F{{s, 0, 0, 0, 1, 0, 0, 0, 1.2}}, dF{{0, 1, 0, sign, 0, 0, 0, 0, 0}};
        EXPECT_GT(energy_of(dF, F, soft.invertible(), Tangent::definite), -1e-12) << s << sign;
      }
  }

  // With the same F everywhere, what a definite tangent has in place of the stress that it leaves
  // out differs from it by a divergence.
  TEST(MatrixFreeElasticity, DefiniteTangentIsTheExactOneInsideABodySqueezedEvenly)
  {
    CellLattice lattice{
      NodeLattice(std::array<int, 3>{{4, 3, 3}}), Direction({1, 1, 1}), {}, {}, {}};
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i)
        {
          lattice.gauss_cells.push_back({{{i, j, k}}, {}});
          lattice.gauss_cells.back().weights.fill(0.125);
        }
    const UniformCells<double> cells(lattice);
    const NodeLattice &nodes = lattice.nodes;
    LatticeVector<double> u(nodes), x(nodes), exact(nodes), definite(nodes);
    const double F[3][3] = {{0.4, 0.1, -0.2}, {0, 0.5, 0.3}, {0.1, 0, 1.1}};
    for (int k = 0; k <= 3; ++k)
      for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 4; ++i)
          for (int c = 0; c < 3; ++c)
          {
            const std::size_t entry = nodes.entry(i, j, k);
            const int X[3]          = {i, j, k};
            u.component(c)[entry]   = F[c][0] * i + F[c][1] * j + F[c][2] * k - X[c];
            x.component(c)[entry]   = std::sin(7. * entry + c);
          }
    MatrixFreeElasticity<double> elasticity(cells, Material("Neo-Hookean", 2.9, 0.45));
    elasticity.set_state(u, Tangent::definite);
    elasticity.vmult(definite, x);
    elasticity.set_state(u);
    elasticity.vmult(exact, x);
    double largest = 0, at_surface = 0;
    for (int k = 0; k <= 3; ++k)
      for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 4; ++i)
          for (int c = 0; c < 3; ++c)
          {
            const std::size_t entry = nodes.entry(i, j, k);
            const double difference =
              std::abs(definite.component(c)[entry] - exact.component(c)[entry]);
            const bool is_inside = i % 4 > 0 && j % 3 > 0 && k % 3 > 0;
            double &place        = is_inside ? largest : at_surface;
            place                = std::max(place, difference);
          }
    EXPECT_LT(largest, 1e-12 * at_surface);
    EXPECT_GT(at_surface, 1);
  }

  TEST(CellLattice, IsRefusedWhereCellsAreNotAlike)
  {
    const auto refused = [](const Discretization &discretization) {
      EXPECT_THROW(cell_lattice(discretization), BadInput);
    };
    refused(*problem("sphere", "weighted cell", 6, 1, 1).discretization);
    refused(*problem("sphere", "weighted cell", 4, 2).discretization);
    refused(*problem("cylinder", "tetrahedra", 4).discretization);
    const auto body = make_sphere(1);
    GridParameters grid;
    grid.cells = {4};
    CutParameters cut;
    cut.alpha = 1e-3;
    refused(Immersed("weighted cell", 1, grid, cut, *body, MPI_COMM_SELF));
    cut.alpha         = 0;
    cut.ghost_penalty = 0.1;
    refused(Immersed("weighted cell", 1, grid, cut, *body, MPI_COMM_SELF));
  }

  TEST(MatrixFreeElasticity, RefusesInvertedPoints)
  {
    const Problem p           = problem("sphere", "weighted cell", 4);
    const CellLattice lattice = cell_lattice(*p.discretization);
    const UniformCells<float> cells(lattice);
    MatrixFreeElasticity<float> matrix_free(cells, Material("Neo-Hookean", 5000, 0.3));
    LatticeVector<float> u(lattice.nodes), r(lattice.nodes);
    Vector mirrored = p.discretization->make_vector();
    for (unsigned int node = 0; node < p.discretization->n_owned_nodes(); ++node)
      mirrored.local_element(3 * node) = -2 * p.discretization->node_positions()[node][0];
    copy(mirrored, lattice.entries, u);
    EXPECT_NEAR(matrix_free.min_jacobian(u), -1, 1e-5);
    EXPECT_THROW(matrix_free.energy(u), InvertedPoint);
    EXPECT_THROW(matrix_free.residual(u, r), InvertedPoint);
    EXPECT_THROW(matrix_free.set_state(u), InvertedPoint);
  }
} // namespace
