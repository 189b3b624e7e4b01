// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card for flat patches, on the host and where there is a card, against
// the operator of the host; and rows that change.

#include <softcell/operators/cuda_flat_elasticity.h>
#include <softcell/operators/flat_elasticity.h>

#include "../devices.h"
#include "lattice.h"
#include "matrix_free_problems.h"

#include <softcell/base/exceptions.h>

namespace
{
  using namespace softcell;

  template <class Device>
  class CudaFlatElasticityTest : public DeviceTest<Device>
  {
  };
  TYPED_TEST_SUITE(CudaFlatElasticityTest, Devices, DeviceNames);

  template <class Real>
  using Numbers = std::vector<Real>;

  /// Operators of host and device on the same patches.
  template <class Real, class Device>
  struct Both
  {
    using Field = DeviceArray<Real, Device>;

    FlatPatches<Real> host_patches, device_patches;
    FlatElasticity<Real> host;
    CudaFlatElasticity<Real, Device> device;

    Both(const Discretization &discretization,
         const std::vector<Material> &materials,
         const unsigned int spare = 0)
        : host_patches(discretization, FlatPatches<Real>::pack_width, spare),
          device_patches(discretization, card_width, spare),
          host(host_patches, materials),
          device(device_patches.arrays(), materials)
    {
    }

    void expect_agreement(const Vector &u, const Vector &x, const double bound)
    {
      const Numbers<Real> U(u.begin(), u.end()), X(x.begin(), x.end());
      Numbers<Real> expected(U.size());
      DeviceArray<Real, Device> y(U.size());
      host.set_state({U.data(), U.size()});
      device.set_state(Field(by_component(U)));

      host.residual({expected.data(), expected.size()});
      device.residual(y);
      compare(y, expected, bound);

      host.vmult({expected.data(), expected.size()}, {X.data(), X.size()});
      device.vmult(y, Field(by_component(X)));
      compare(y, expected, bound);
    }

    static Numbers<Real> by_component(const Numbers<Real> &values)
    {
      Numbers<Real> result(values.size());
      for (std::size_t i = 0; i < values.size(); ++i)
        result[i % 3 * (values.size() / 3) + i / 3] = values[i];
      return result;
    }

    static void compare(const Field &y, const Numbers<Real> &expected, const double bound)
    {
      const Numbers<Real> other = by_component(expected);
      EXPECT_LT((difference<Real, Device>(y, {other.data(), other.size()})), bound);
    }
  };

  TYPED_TEST(CudaFlatElasticityTest, IsTheOneOfTheHost)
  {
    struct Case
    {
      const char *type, *method;
      unsigned int cells, degree, surface_refinement;
    };
    for (const Case &c :
         {Case{"cylinder", "tetrahedra", 4, 1, 0}, Case{"sphere", "tetrahedra", 3, 2, 0},
          Case{"sphere", "moment fitting", 5, 1, 0}, Case{"sphere", "weighted cell", 6, 1, 1}})
    {
      const Problem p = problem(c.type, c.method, c.cells, c.degree, c.surface_refinement);
      const Vector u = wavy(*p.discretization, 0.03, 2), x = wavy(*p.discretization, 1, 7);
      for (const std::string &law : all_laws)
      {
        SCOPED_TRACE(std::string(c.method) + ' ' + law);
        const Material material(law, 5000, 0.3);
        Both<double, TypeParam>(*p.discretization, {material}).expect_agreement(u, x, 1e-12);
        Both<float, TypeParam>(*p.discretization, {material}).expect_agreement(u, x, 1e-5);
      }
    }
  }

  /// A lattice of two materials.
  struct TwoMaterials
  {
    UnitCells cells = UnitCells({{4, 3, 3}}, 2);
    std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3),
                                    Material("linear", 300, 0.45)};

    TwoMaterials()
    {
      for (unsigned int i = 0; i < cells.cells.size(); i += 2)
        cells.cells[i].labels = {1};
    }
  };

  TYPED_TEST(CudaFlatElasticityTest, MayHaveSeveralMaterials)
  {
    const TwoMaterials two;
    Both<double, TypeParam>(two.cells, two.materials)
      .expect_agreement(wavy(two.cells, 0.03, 2), wavy(two.cells, 1, 7), 1e-12);
  }

  // Points lose nodes, win others, and change their weights, as when a body is cut.
  TYPED_TEST(CudaFlatElasticityTest, TakesRowsThatChange)
  {
    const UnitCells cells({{4, 3, 3}}, 2);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const Vector u = wavy(cells, 0.03, 2), x = wavy(cells, 1, 7);
    Both<double, TypeParam> both(cells, materials, 4);
    both.expect_agreement(u, x, 1e-12);
    const Numbers<double> X(x.begin(), x.end());
    Numbers<double> before(X.size()), after(X.size());
    both.host.vmult({before.data(), before.size()}, {X.data(), X.size()});

    const std::vector<unsigned int> nodes{3, 17, 21, 40, 41, 55, 7, 30, 11};
    Numbers<double> gradients(3 * nodes.size());
    for (unsigned int i = 0; i < gradients.size(); ++i)
      gradients[i] = 0.05 * std::sin(1 + i * i);
    for (const std::size_t row : {5, 70, 200, 201})
    {
      EXPECT_TRUE(both.host_patches.change(row, 0.1, nodes, gradients));
      EXPECT_TRUE(both.device_patches.change(row, 0.1, nodes, gradients));
    }
    const RowChanges<double> changes = both.device_patches.take_changes();
    both.device.change(changes);
    both.expect_agreement(u, x, 1e-12);
    both.host.vmult({after.data(), after.size()}, {X.data(), X.size()});
    EXPECT_NE(before, after);

    // four rows of points, and rows of the nodes that they had (8 each at most) or have
    EXPECT_LE(changes.rows.size(), 4 + 4 * 8 + nodes.size());
    EXPECT_TRUE(both.device_patches.take_changes().rows.empty());
  }

  TEST(FlatPatches, ChangesNothingWithoutRoom)
  {
    const UnitCells cells({{4, 3, 3}}, 2);
    FlatPatches<double> patches(cells, card_width, 2);
    const std::vector<unsigned int> nodes(11, 1);
    EXPECT_FALSE(patches.change(5, 0.1, nodes, Numbers<double>(33, 1.)));
    EXPECT_TRUE(patches.take_changes().rows.empty());
    // a node of the middle has 64 points, those of its batch as many, so that there is room for two
    std::vector<unsigned int> n_points(cells.node_positions().size(), 0);
    const FlatArrays<double> arrays = patches.arrays();
    unsigned int fullest            = 0;
    for (unsigned int k = 0; k < arrays.points.starts[arrays.points.n_batches] * card_width; ++k)
      if (arrays.points.gradients[k / card_width * 3 * card_width + k % card_width] != 0)
        if (++n_points[arrays.points.numbers[k]] > n_points[fullest])
          fullest = arrays.points.numbers[k];
    unsigned int n_changed = 0;
    for (std::size_t row = 0; row < 8 * cells.cells.size(); ++row)
      if (std::find(cells.cells[row / 8].nodes.begin(), cells.cells[row / 8].nodes.end(),
                    fullest) == cells.cells[row / 8].nodes.end())
        n_changed += patches.change(row, 1, {fullest}, {1, 0, 0});
    EXPECT_EQ(n_changed, 2U);
  }
} // namespace
