// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card, on the host and where there is a card, against the operator of
// the host.

#include <softcell/operators/cuda_elasticity.h>
#include <softcell/operators/matrix_free_elasticity.h>

#include "../devices.h"
#include "matrix_free_problems.h"

#include <softcell/base/exceptions.h>

namespace
{
  using namespace softcell;

  template <class Device>
  class CudaElasticityTest : public DeviceTest<Device>
  {
  };
  TYPED_TEST_SUITE(CudaElasticityTest, Devices, DeviceNames);

  template <class Device, class Real>
  DeviceArray<Real, Device> on_device(const LatticeVector<Real> &field)
  {
    DeviceArray<Real, Device> result(field.entries().size());
    result.copy_from(field.entries().data());
    return result;
  }

  template <class Real, class Device>
  void expect_kernels_agree(const Discretization &discretization,
                            const Material &material,
                            const double bound)
  {
    const CellLattice lattice = cell_lattice(discretization);
    LatticeVector<Real> u(lattice.nodes), x(lattice.nodes), y(lattice.nodes);
    copy(wavy(discretization, 0.03, 2), lattice.entries, u);
    copy(wavy(discretization, 1, 7), lattice.entries, x);
    const UniformCells<Real> cells(lattice);
    MatrixFreeElasticity<Real> host(cells, material);
    CudaElasticity<Real, Device> device(CellBricks<Real>(lattice), material);
    const auto device_u = on_device<Device>(u), device_x = on_device<Device>(x);
    DeviceArray<Real, Device> device_y(device_x.size()), device_blocks(2 * device_x.size());

    device.residual(device_u, device_y);
    host.residual(u, y);
    EXPECT_LT((difference<Real, Device>(device_y, y.entries())), bound);

    device.set_state(device_u);
    host.set_state(u);
    device.vmult(device_y, device_x);
    host.vmult(y, x);
    EXPECT_LT((difference<Real, Device>(device_y, y.entries())), bound);

    LatticeBlocks<Real> blocks(lattice.nodes);
    device.diagonal(device_blocks);
    host.diagonal(blocks);
    EXPECT_LT((difference<Real, Device>(device_blocks, blocks.entries())), bound);
  }

  // The box has bricks of full cells alone, and more cells along y than bricks have room for.
  TYPED_TEST(CudaElasticityTest, IsTheOneOfTheHost)
  {
    for (const std::string type : {"cylinder", "sphere", "box"})
    {
      const Problem p = problem(type, "weighted cell", type == "box" ? 9 : 7);
      for (const std::string &model : all_laws)
      {
        SCOPED_TRACE(type + ' ' + model);
        const Material material(model, 5000, 0.3);
        expect_kernels_agree<double, TypeParam>(*p.discretization, material, 1e-12);
        expect_kernels_agree<float, TypeParam>(*p.discretization, material, 1e-5);
      }
      const Material invertible = Material("Neo-Hookean", 5000, 0.3).invertible();
      expect_kernels_agree<double, TypeParam>(*p.discretization, invertible, 1e-12);
    }
  }

  TYPED_TEST(CudaElasticityTest, IsTheOneOfTheHostOnALiver)
  {
    const Problem p = liver("weighted cell", 12);
    if (!p.discretization)
      GTEST_SKIP() << "The liver's image is missing.";
    const Material material("Neo-Hookean", 5000, 0.45);
    expect_kernels_agree<double, TypeParam>(*p.discretization, material, 1e-12);
    expect_kernels_agree<float, TypeParam>(*p.discretization, material, 1e-5);
  }

  TYPED_TEST(CudaElasticityTest, IsZeroInHeldUnknowns)
  {
    const Problem p           = problem("sphere", "weighted cell", 6);
    const CellLattice lattice = cell_lattice(*p.discretization);
    const Material material("linear", 5000, 0.3);
    CudaElasticity<double, TypeParam> device(CellBricks<double>(lattice), material);
    LatticeVector<double> x(lattice.nodes);
    copy(wavy(*p.discretization, 1, 7), lattice.entries, x);
    const auto device_x = on_device<TypeParam>(x);
    DeviceArray<double, TypeParam> all(device_x.size()), free(device_x.size());
    device.set_state(DeviceArray<double, TypeParam>(device_x.size()));
    device.vmult(all, device_x);

    const std::size_t n = lattice.nodes.size(), node = lattice.entries[20];
    std::vector<unsigned char> held(n, 0);
    held[node] = 1 + 4;
    device.hold(held);
    device.vmult(free, device_x);
    std::vector<double> expected = on_host(all);
    EXPECT_NE(expected[node], 0);
    EXPECT_NE(expected[node + n], 0);
    expected[node] = expected[node + 2 * n] = 0;
    EXPECT_EQ((difference<double, TypeParam>(free, {expected.data(), expected.size()})), 0);
  }

  TYPED_TEST(CudaElasticityTest, RefusesWhatItCannotDo)
  {
    const Problem fitted = problem("sphere", "moment fitting", 4);
    EXPECT_THROW(CellBricks<float>(cell_lattice(*fitted.discretization)), BadInput);

    const Problem p           = problem("sphere", "weighted cell", 4);
    const CellLattice lattice = cell_lattice(*p.discretization);
    CudaElasticity<float, TypeParam> device(CellBricks<float>(lattice),
                                            Material("Neo-Hookean", 5000, 0.3));
    LatticeVector<float> u(lattice.nodes);
    Vector mirrored = p.discretization->make_vector();
    for (unsigned int node = 0; node < p.discretization->n_owned_nodes(); ++node)
      mirrored.local_element(3 * node) = -2 * p.discretization->node_positions()[node][0];
    copy(mirrored, lattice.entries, u);
    const auto device_u = on_device<TypeParam>(u);
    DeviceArray<float, TypeParam> r(device_u.size());
    EXPECT_THROW(device.residual(device_u, r), InvertedPoint);
    EXPECT_THROW(device.set_state(device_u), InvertedPoint);
  }
} // namespace
