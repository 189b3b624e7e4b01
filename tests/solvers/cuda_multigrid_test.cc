// SPDX-License-Identifier: LGPL-2.1-or-later
// The multigrid of the graphics card, on the host and where there is a card, against the host's.

#include <softcell/solvers/cuda_multigrid.h>
#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/grid_levels.h>
#include <softcell/solvers/matrix_free_solver.h>

#include "../devices.h"
#include "held_body.h"

#include <limits>
#include <random>

namespace
{
  using namespace softcell;

  template <class Device>
  class CudaMultigridTest : public DeviceTest<Device>
  {
  };
  TYPED_TEST_SUITE(CudaMultigridTest, Devices, DeviceNames);

  template <class Real, class Device>
  void expect_cycles_agree(const HeldBody &body,
                           const Material &material,
                           const Vector &u,
                           const double bound)
  {
    GeometricMultigrid<Real> host(*body.cells, material, body.held);
    CudaMultigrid<Real, Device> device(*body.cells, material, body.held);
    LatticeVector<Real> state(body.cells->nodes), y(body.cells->nodes);
    copy(u, body.cells->entries, state);
    const auto x = rough_field<Real>(host.unknowns(), 3);
    DeviceArray<Real, Device> device_x(x.entries().size()), device_y(device_x.size());
    device.set_state(device_x);
    device.vmult(device_y, device_x); // what is kept from this must not stay
    device_x.copy_from(state.entries().data());
    host.set_state(state);
    device.set_state(device_x);
    device_x.copy_from(x.entries().data());
    for (const Tangent smoother : {Tangent::definite, Tangent::exact})
    {
      host.set_smoother(smoother);
      device.set_smoother(smoother);
      host.vmult(y, x);
      device.vmult(device_y, device_x);
      device.vmult(device_y, device_x); // as recorded
      EXPECT_LT((difference<Real, Device>(device_y, y.entries())), bound);
    }
  }

  // Compressed, the exact tangent is indefinite.
  TYPED_TEST(CudaMultigridTest, IsTheOneOfTheHost)
  {
    for (const std::string type : {"cylinder", "sphere"})
      for (const double stretch : {0., -0.2})
      {
        SCOPED_TRACE(type + ' ' + std::to_string(stretch));
        const HeldBody body(type, type == "sphere" ? 40 : 19);
        const Vector u = body.bent(0.02, stretch);
        const Material material("Neo-Hookean", 5000, 0.4);
        expect_cycles_agree<double, TypeParam>(body, material, u, 1e-10);
        expect_cycles_agree<float, TypeParam>(body, material, u, 1e-5);
      }
    const HeldBody body("cylinder", 19);
    for (const std::string law : {"Saint-Venant-Kirchhoff", "linear"})
      expect_cycles_agree<double, TypeParam>(body, Material(law, 5000, 0.3), body.bent(0.02, 0),
                                             1e-10);
  }

  // Both are conjugate gradients in double precision with a V-cycle in single precision. What its
  // rounding does to the residuals is seen on the host, at displacements that differ by as much.
  TYPED_TEST(CudaMultigridTest, LeavesTheIterationsOfTheHost)
  {
    const HeldBody body("cylinder", 36);
    const Material material("Neo-Hookean", 5000, 0.3);
    LinearSolverParameters parameters;
    parameters.tolerance      = 1e-8;
    parameters.max_iterations = 50;
    MatrixFreeSolver host(*body.discretization, material, body.constrained, parameters);
    const Vector u = body.bent(0.02, 0);
    Vector b       = body.discretization->make_vector(), expected(b);
    for (unsigned int node = 0; node < body.discretization->n_owned_nodes(); ++node)
      b.local_element(3 * node) = 1;
    for (const unsigned int unknown : body.constrained)
      b.local_element(unknown) = 0;
    const auto host_history = [&](const Vector &state) {
      host.set_state(state);
      host.set_matrix(BlockMatrix(body.discretization->partitioner(), {}), {}, {});
      host.solve(expected, b);
      return host.history();
    };
    std::vector<std::vector<double>> rounded;
    std::mt19937 random;
    for (unsigned int n = 0; n < 4; ++n)
    {
      std::uniform_real_distribution<double> rounding(-1, 1);
      Vector state = u;
      for (unsigned int i = 0; i < state.locally_owned_size(); ++i)
        state.local_element(i) *= 1 + std::numeric_limits<float>::epsilon() * rounding(random);
      rounded.push_back(host_history(state));
    }
    const std::vector<double> history = host_history(u);

    LatticeVector<double> field(body.cells->nodes);
    const std::size_t size = field.entries().size();
    DeviceArray<double, TypeParam> device_u(size), device_b(size), device_x(size);
    copy(u, body.cells->entries, field);
    device_u.copy_from(field.entries().data());
    copy(b, body.cells->entries, field);
    device_b.copy_from(field.entries().data());
    CudaMultigrid<float, TypeParam> multigrid(*body.cells, material, body.held,
                                              MatrixFreeSolver::smoother_degree);
    multigrid.set_state(device_u, Tangent::exact);
    CudaElasticity<double, TypeParam> tangent(CellBricks<double>(*body.cells), material);
    tangent.hold(multigrid.held());
    tangent.set_state(device_u);
    CudaCG<double, TypeParam> cg(size);
    cg.solve([&](auto &y, const auto &x) { tangent.vmult(y, x); },
             [&](auto &z, const auto &r) { multigrid.vmult(z, r); }, device_x, device_b,
             parameters.tolerance, parameters.max_iterations);

    ASSERT_EQ(cg.history().size(), history.size());
    double rounding = 0; // the largest relative difference so far
    for (unsigned int i = 0; i < history.size(); ++i)
    {
      for (const std::vector<double> &other : rounded)
      {
        ASSERT_EQ(other.size(), history.size());
        rounding = std::max(rounding, std::abs(other[i] / history[i] - 1));
      }
      if (rounding > 0.01) // what follows tells of rounding alone
        break;
      // the kernels round more often than the displacement is, but not ten times as much
      EXPECT_NEAR(cg.history()[i] / history[i], 1, 10 * rounding) << "residual " << history[i];
    }
    copy(expected, body.cells->entries, field);
    EXPECT_LT((difference<double, TypeParam>(device_x, field.entries())), 1e-7);
  }
} // namespace
