// SPDX-License-Identifier: LGPL-2.1-or-later
// The conjugate gradients of the graphics card, on the host and where there is a card.

#include <softcell/solvers/cuda_cg.h>

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/operators/cuda_elasticity.h>
#include <softcell/operators/elasticity.h>
#include <softcell/operators/uniform_cells.h>
#include <softcell/solvers/linear_solver.h>

#include "../devices.h"

#include <cmath>

namespace
{
  using namespace softcell;

  template <class Device>
  class CudaCGTest : public DeviceTest<Device>
  {
  };
  TYPED_TEST_SUITE(CudaCGTest, Devices, DeviceNames);

  /// A clamped ball of weighted cells under its weight.
  struct ClampedBall
  {
    std::unique_ptr<Body> body = make_sphere(1);
    std::unique_ptr<Immersed> cells;
    std::vector<unsigned int> clamped; // unknowns
    Vector load;

    ClampedBall()
    {
      GridParameters grid;
      grid.cells = {6};
      cells =
        std::make_unique<Immersed>("weighted cell", 1, grid, CutParameters(), *body, MPI_COMM_SELF);
      load          = cells->make_vector();
      double bottom = 0;
      for (const Point &X : cells->node_positions())
        bottom = std::min(bottom, X[2]);
      for (unsigned int node = 0; node < cells->n_owned_nodes(); ++node)
        if (cells->node_positions()[node][2] < bottom + 1e-6)
          for (unsigned int c = 0; c < dim; ++c)
            clamped.push_back(3 * node + c);
        else
          load.local_element(3 * node) = 1;
    }
  };

  /// Solves on the device.
  template <class Real, class Device>
  Vector solve_on_device(const ClampedBall &ball,
                         const Material &material,
                         const double tolerance,
                         std::vector<double> &history)
  {
    const CellLattice lattice = cell_lattice(*ball.cells);
    CudaElasticity<Real, Device> tangent(CellBricks<Real>(lattice), material);
    std::vector<unsigned char> held(lattice.nodes.size(), 0);
    for (const unsigned int unknown : ball.clamped)
      held[lattice.entries[unknown / 3]] |= 1 << unknown % 3;
    tangent.hold(held);

    LatticeVector<Real> field(lattice.nodes);
    copy(ball.load, lattice.entries, field);
    const std::size_t size = field.entries().size();
    DeviceArray<Real, Device> x(size), b(size), blocks(2 * size);
    tangent.set_state(x);
    tangent.diagonal(blocks);
    b.copy_from(field.entries().data());
    CudaCG<Real, Device> cg(size);
    const InverseDiagonal<Real, Device> inverse(blocks, size);
    cg.solve([&](auto &y, const auto &p) { tangent.vmult(y, p); },
             [&](auto &z, const auto &r) { inverse.vmult(z, r); }, x, b, tolerance, 500);
    history = cg.history();
    x.copy_to(field.entries().data());
    Vector result = ball.cells->make_vector();
    copy(field, lattice.entries, result);
    return result;
  }

  // The history is compared while it is far above rounding errors, which grow with iterations.
  TYPED_TEST(CudaCGTest, IteratesAsTheHostDoes)
  {
    const ClampedBall ball;
    const Material material("Neo-Hookean", 5000, 0.3);
    const Elasticity elasticity(*ball.cells, {material});
    BlockMatrix K(ball.cells->partitioner(), elasticity.couplings());
    elasticity.add_tangent(ball.cells->make_vector(), K);
    K.compress();
    K.constrain(ball.clamped, 1.);
    LinearSolverParameters parameters;
    parameters.preconditioner = "Jacobi";
    parameters.tolerance      = 1e-8;
    const auto solver         = make_linear_solver(parameters);
    solver->set_matrix(K, ball.cells->node_positions(), ball.clamped);
    Vector expected = ball.cells->make_vector();
    solver->solve(expected, ball.load);

    std::vector<double> history;
    Vector x = solve_on_device<double, TypeParam>(ball, material, 1e-8, history);
    ASSERT_EQ(history.size(), solver->history().size());
    for (unsigned int i = 0; i < history.size(); ++i)
      EXPECT_NEAR(history[i], solver->history()[i], 1e-10);
    x -= expected;
    EXPECT_LT(x.linfty_norm(), 1e-10 * expected.linfty_norm());

    Vector rough = solve_on_device<float, TypeParam>(ball, material, 1e-5, history);
    rough -= expected;
    EXPECT_LT(rough.linfty_norm(), 1e-3 * expected.linfty_norm());
  }

  /// y = factors * x
  auto times(const std::vector<double> &factors)
  {
    return [factors](auto &y, const auto &x) {
      std::vector<double> values = on_host(x);
      for (std::size_t i = 0; i < factors.size(); ++i)
        values[i] *= factors[i];
      y.copy_from(values.data());
    };
  }

  /// A x = entries * x
  template <class Device>
  struct Diagonal
  {
    std::vector<double> entries;

    unsigned int solve(const std::vector<double> &b, std::vector<double> &x) const
    {
      const std::size_t n = entries.size();
      DeviceArray<double, Device> device_b(b), device_x(n);
      CudaCG<double, Device> cg(n);
      const unsigned int iterations = cg.solve(
        times(entries), [](auto &z, const auto &r) { z.copy_from(r); }, device_x, device_b, 1e-12,
        5);
      x.resize(n);
      device_x.copy_to(x.data());
      return iterations;
    }
  };

  // More entries than all threads of all blocks, and a rest.
  TYPED_TEST(CudaCGTest, NeedsOneIterationPerEigenvalue)
  {
    Diagonal<TypeParam> A;
    std::vector<double> b, x;
    for (unsigned int i = 0; i < 70001; ++i)
    {
      A.entries.push_back(1 + i % 3);
      b.push_back(1);
    }
    EXPECT_EQ(A.solve(b, x), 3U);
    for (unsigned int i = 0; i < x.size(); ++i)
      ASSERT_NEAR(x[i], 1. / (1 + i % 3), 1e-12);
  }

  TYPED_TEST(CudaCGTest, StopsAtNegativeCurvature)
  {
    std::vector<double> x;
    EXPECT_EQ((Diagonal<TypeParam>{{-4, -4}}.solve({1, 1}, x)), 1U);
    EXPECT_DOUBLE_EQ(x[0], 0.25);
    EXPECT_EQ((Diagonal<TypeParam>{{4, -1}}.solve({1, 0.5}, x)), 2U);
    // the first step: 1.25 / (4 - 0.25)
    EXPECT_DOUBLE_EQ(x[0], 1 / 3.);
    EXPECT_DOUBLE_EQ(x[1], 0.5 / 3);
    EXPECT_THROW((Diagonal<TypeParam>{{1, 2, 3, 4, 5, 6, 7}}.solve({1, 1, 1, 1, 1, 1, 1}, x)),
                 NotConverged);
    EXPECT_THROW((Diagonal<TypeParam>{{1, NAN}}.solve({1, 1}, x)), NotConverged);
  }

  TYPED_TEST(CudaCGTest, ForgetsASolveThatFailed)
  {
    const std::vector<double> ones(2, 1.);
    DeviceArray<double, TypeParam> b(ones), x(2);
    CudaCG<double, TypeParam> cg(2);
    unsigned int fails_at = 2, products = 0;
    const auto solve = [&] {
      return cg.solve(
        [&](auto &y, const auto &p) {
          std::vector<double> values = on_host(p);
          values[1] *= ++products == fails_at ? NAN : 2;
          y.copy_from(values.data());
        },
        [](auto &z, const auto &r) { z.copy_from(r); }, x, b, 1e-12, 5);
    };
    EXPECT_THROW(solve(), NotConverged);
    fails_at = 0;
    EXPECT_EQ(solve(), 2U);
    EXPECT_NEAR(on_host(x)[1], 0.5, 1e-12);
  }

  // A = diag(3, -1), M = diag(1, -1) and b = (2, 1): r.z is 3 at first, and p = (2, -1), A p = (6,
  // 1), so x = 3 / 11 p and r = (4, 8) / 11, whose r.z is negative.
  TYPED_TEST(CudaCGTest, StopsWhereThePreconditionerIsIndefinite)
  {
    CudaCG<double, TypeParam> cg(2);
    DeviceArray<double, TypeParam> x(2), b(std::vector<double>{2, 1});
    EXPECT_EQ(cg.solve(times({3, -1}), times({1, -1}), x, b, 1e-12, 5), 2U);
    EXPECT_DOUBLE_EQ(on_host(x)[0], 6. / 11);
    EXPECT_DOUBLE_EQ(on_host(x)[1], -3. / 11);
    EXPECT_DOUBLE_EQ(cg.largest_eigenvalue(), 11. / 3); // p.Ap / r.z
    b.copy_from(std::vector<double>{1, 2}.data());
    EXPECT_THROW(cg.solve(times({3, -1}), times({1, -1}), x, b, 1e-12, 5), NotConverged);
  }

  TYPED_TEST(CudaCGTest, RecordsAnewAfterAnError)
  {
    const DeviceArray<double, TypeParam> two(std::vector<double>{2}), x(std::vector<double>{3});
    DeviceArray<double, TypeParam> y(1);
    const InverseDiagonal<double, TypeParam> half(two, 1);
    typename TypeParam::Recording recording;
    const auto fail = [&] {
      half.vmult(y, x);
      throw std::runtime_error("no more");
    };
    EXPECT_THROW(recording.run(fail), std::runtime_error);
    for (unsigned int run = 0; run < 2; ++run)
    {
      y.copy_from(x);
      recording.run([&] { half.vmult(y, x); });
      EXPECT_EQ(on_host(y)[0], 1.5);
    }
  }

  // After as many iterations as there are eigenvalues the tridiagonal matrix has all of them.
  TYPED_TEST(CudaCGTest, KnowsTheLargestEigenvalue)
  {
    CudaCG<double, TypeParam> cg(4);
    DeviceArray<double, TypeParam> x(4), b(std::vector<double>{1, 2, 3, 4});
    EXPECT_EQ(cg.solve(times({1, 6, 2, 4}), times({1, 0.5, 2, 0.5}), x, b, 1e-12, 5), 4U);
    EXPECT_NEAR(cg.largest_eigenvalue(), 4, 1e-10);
  }
} // namespace
