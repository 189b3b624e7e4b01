// SPDX-License-Identifier: LGPL-2.1-or-later
// The V-cycle as an operator, and how few iterations it leaves.

#include <softcell/base/exceptions.h>
#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/grid_levels.h>
#include <softcell/solvers/matrix_free_solver.h>

#include "held_body.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  double volume(const CellLattice &cells)
  {
    double sum = 0;
    for (const GaussCell &cell : cells.gauss_cells)
      sum = std::accumulate(cell.weights.begin(), cell.weights.end(), sum);
    for (const PointCell &cell : cells.point_cells)
      sum = std::accumulate(cell.weights.begin(), cell.weights.end(), sum);
    return sum;
  }

  /// Of conjugate gradients at a displacement, with a force across that is the same everywhere.
  unsigned int iterations(const HeldBody &body,
                          const Material &material,
                          const Vector &u,
                          const double tolerance = 1e-6)
  {
    LinearSolverParameters parameters;
    parameters.tolerance      = tolerance;
    parameters.max_iterations = 200;
    MatrixFreeSolver solver(*body.discretization, material, body.constrained, parameters);
    solver.set_state(u);
    const BlockMatrix no_supports(body.discretization->partitioner(), {});
    solver.set_matrix(no_supports, {}, {});
    Vector b = body.discretization->make_vector(), x(b);
    for (unsigned int node = 0; node < body.discretization->n_owned_nodes(); ++node)
      b.local_element(3 * node) = 1;
    return solver.solve(x, b);
  }

  unsigned int node_near(const HeldBody &body, const Point &X)
  {
    const auto &positions = body.discretization->node_positions();
    return std::min_element(positions.begin(), positions.end(),
                            [&](const Point &a, const Point &b) {
                              return a.distance_square(X) < b.distance_square(X);
                            }) -
           positions.begin();
  }

  TEST(GeometricMultigrid, CoarseCellsKeepTheVolume)
  {
    for (const std::string method : {"weighted cell", "moment fitting"})
      for (const unsigned int n : {17, 24})
      {
        const HeldBody body("sphere", n, method);
        const double exact  = volume(*body.cells);
        CellLattice coarser = *body.cells;
        while (coarser.nodes.n_cells() != std::array<int, 3>{{1, 1, 1}})
        {
          coarser = coarse_cells(coarser);
          EXPECT_NEAR(volume(coarser), exact, 1e-13 * exact);
        }
        EXPECT_EQ(coarser.gauss_cells.size(), 1U);
      }
  }

  // Sums up to each coarse node what interpolation takes from it.
  TEST(GeometricMultigrid, TransferIsItsTransposeAndExactForLinearFunctions)
  {
    const HeldBody body("sphere", 20);
    const LatticeUnknowns fine(*body.cells, {});
    const CellLattice cells = coarse_cells(*body.cells);
    const LatticeUnknowns coarse(cells, fine);
    const auto y = rough_field<double>(fine, 1), X = rough_field<double>(coarse, 2);
    LatticeVector<double> x(fine.nodes()), Y(coarse.nodes());
    fine.interpolate(X, x);
    coarse.sum_up(y, Y);
    EXPECT_NEAR(fine.dot(x, y), coarse.dot(X, Y),
                1e-13 * std::sqrt(fine.dot(x, x) * fine.dot(y, y)));

    // u = place along x, then y, then z, in cells
    const auto fill = [](LatticeVector<double> &u, const double edge) {
      const NodeLattice &nodes = u.lattice();
      for (int k = 0; k <= nodes.n_cells()[2]; ++k)
        for (int j = 0; j <= nodes.n_cells()[1]; ++j)
          for (int i = 0; i <= nodes.n_cells()[0]; ++i)
          {
            const std::size_t node = nodes.entry(i, j, k);
            u.component(0)[node]   = edge * i;
            u.component(1)[node]   = edge * j;
            u.component(2)[node]   = edge * k;
          }
    };
    LatticeVector<double> exact(fine.nodes()), exact_coarse(coarse.nodes()), taken(coarse.nodes());
    fill(exact, 1);
    fill(exact_coarse, 2);
    fine.interpolate(exact_coarse, x);
    for (const std::size_t entry : fine.free_entries())
      EXPECT_NEAR(x.entries()[entry], exact.entries()[entry], 1e-12);
    coarse.take(fine, exact, taken);
    for (const std::size_t entry : coarse.free_entries())
      EXPECT_NEAR(taken.entries()[entry], exact_coarse.entries()[entry], 1e-12);
  }

  TEST(GeometricMultigrid, IsSymmetricAndPositiveDefinite)
  {
    const HeldBody body("cylinder", 19);
    GeometricMultigrid<double> multigrid(*body.cells, Material("Neo-Hookean", 5000, 0.4),
                                         body.held);
    const LatticeUnknowns &unknowns = multigrid.unknowns();
    LatticeVector<double> u(unknowns.nodes());
    for (const double stretch : {0., -0.2}) // compressed, where the tangent itself is indefinite
    {
      copy(body.bent(0.02, stretch), body.cells->entries, u);
      multigrid.set_state(u);
      LatticeVector<double> Mx(unknowns.nodes()), My(unknowns.nodes());
      for (unsigned int seed = 0; seed < 10; ++seed)
      {
        multigrid.set_smoother(seed < 5 ? Tangent::definite : Tangent::exact);
        const auto x = rough_field<double>(unknowns, seed),
                   y = rough_field<double>(unknowns, seed + 100);
        multigrid.vmult(Mx, x);
        multigrid.vmult(My, y);
        const double xMx = unknowns.dot(x, Mx), yMy = unknowns.dot(y, My);
        EXPECT_GT(xMx, 0);
        EXPECT_NEAR(unknowns.dot(x, My), unknowns.dot(y, Mx), 1e-12 * std::sqrt(xMx * yMy));
      }
    }
  }

  TEST(GeometricMultigrid, TakesFewIterationsAtEveryGridPosition)
  {
    for (const unsigned int n : {18, 19, 20, 36, 37, 38})
    {
      SCOPED_TRACE(n);
      const HeldBody body("cylinder", n);
      for (const double nu : {0.3, 0.45})
        EXPECT_LE(
          iterations(body, Material("Neo-Hookean", 5000, nu), body.discretization->make_vector()),
          8U);
    }
  }

  // 30 % shorter and bent, a slender body gives way to the side.
  TEST(GeometricMultigrid, RecognisesAnIndefiniteTangent)
  {
    const HeldBody body("cylinder", 18);
    LinearSolverParameters parameters;
    parameters.tolerance      = 1e-8;
    parameters.max_iterations = 100;
    const Material material("Neo-Hookean", 5000, 0.3);
    MatrixFreeSolver solver(*body.discretization, material, body.constrained, parameters);
    solver.set_state(body.bent(0, -0.3));
    const BlockMatrix no_supports(body.discretization->partitioner(), {});
    solver.set_matrix(no_supports, {}, {});
    Vector b = body.discretization->make_vector(), x(b), Kx(b);
    for (unsigned int node = 0; node < body.discretization->n_owned_nodes(); ++node)
      b.local_element(3 * node) = 1;
    for (const unsigned int unknown : body.constrained)
      b.local_element(unknown) = 0;
    EXPECT_LT(solver.solve(x, b), 100U);
    EXPECT_TRUE(std::isnan(solver.condition()));
    EXPECT_GT(x * b, 0); // a direction of descent
  }

  // Of a cell whose height is a tenth the top gives way to the side, and with the exact smoother
  // the first direction is hardly more than that. The body as a whole still bends as at rest.
  TEST(GeometricMultigrid, BendsTheBodyWhereOneCellGivesWay)
  {
    const HeldBody body("cylinder", 20);
    const double edge  = body.cells->spacing[2];
    const Point corner = body.discretization->node_positions()[node_near(body, Point(0, 0, 1.5))],
                top    = corner + Direction({edge / 2, edge / 2, 0});
    Vector rest        = body.discretization->make_vector(), flat(rest), b(rest), x(rest);
    for (unsigned int node = 0; node < body.discretization->n_owned_nodes(); ++node)
    {
      b.local_element(3 * node) = 1;
      if (body.discretization->node_positions()[node].distance(top) < 0.8 * edge)
        flat.local_element(3 * node + 2) = -0.9 * edge;
    }
    for (const unsigned int unknown : body.constrained)
      b.local_element(unknown) = 0;
    LinearSolverParameters parameters;
    parameters.tolerance      = 1e-6;
    parameters.max_iterations = 100;
    MatrixFreeSolver solver(*body.discretization, Material("Neo-Hookean", 5000, 0.45),
                            body.constrained, parameters);
    const BlockMatrix no_supports(body.discretization->partitioner(), {});
    double work = 0; // of b
    for (const Vector &u : {rest, flat})
    {
      solver.set_state(u);
      solver.set_matrix(no_supports, {}, {});
      EXPECT_LT(solver.solve(x, b), 20U);
      EXPECT_EQ(std::isnan(solver.condition()), work > 0); // tells an indefinite tangent
      EXPECT_GT(x * b, 0.9 * work);
      work = x * b;
    }
  }

  // Springs between two nodes leave the diagonal blocks as they are: attracting or repelling, one
  // of both has negative curvature in the first direction, however that looks.
  TEST(GeometricMultigrid, NamesATangentThatIsNotPositiveDefinite)
  {
    const HeldBody body("cylinder", 18);
    GeometricMultigrid<double> multigrid(*body.cells, Material("linear", 5000, 0.3), body.held);
    const NodeLattice &nodes = body.cells->nodes;
    const LatticeVector<double> rest(nodes);
    const auto y = rough_field<double>(multigrid.unknowns(), 1);
    LatticeVector<double> x(nodes);
    const std::vector<unsigned int> pair{node_near(body, Point(0, 0, 1.5)),
                                         node_near(body, Point(body.cells->spacing[0], 0, 1.5))};
    unsigned int n_refused = 0;
    for (const double stiffness : {1e12, -1e12})
    {
      BlockMatrix springs(body.discretization->partitioner(), {pair});
      std::array<double, 36> values{}; // (3, 2, 3, 2)
      for (unsigned int c = 0; c < 3; ++c)
        values[12 * c + 2 * c + 1] = values[12 * c + 6 + 2 * c] = stiffness;
      springs.add(pair, values.data());
      springs.compress();
      try
      {
        multigrid.set_state(rest, LatticeMatrix<double>(springs, body.cells->entries, nodes));
        multigrid.vmult(x, y);
        EXPECT_TRUE(std::isfinite(multigrid.unknowns().dot(x, x)));
      }
      catch (const NotConverged &)
      {
        ++n_refused;
      }
    }
    EXPECT_GE(n_refused, 1U);
  }
} // namespace
