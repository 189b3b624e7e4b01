// SPDX-License-Identifier: LGPL-2.1-or-later
// The operator on flat patches against the assembled one.

#include <softcell/operators/flat_elasticity.h>

#include "lattice.h"
#include "matrix_free_problems.h"

#include <softcell/base/exceptions.h>

#include <omp.h>

namespace
{
  using namespace softcell;

  template <class Real>
  std::vector<Real> entries_of(const Vector &vector)
  {
    return {vector.begin(), vector.end()};
  }

  template <class Real>
  Vector as_vector(const std::vector<Real> &values, const Vector &like)
  {
    Vector result(like);
    std::copy(values.begin(), values.end(), result.begin());
    return result;
  }

  template <class Real>
  void expect_flat_agreement(const Discretization &discretization,
                             const std::vector<Material> &materials,
                             const FlatPatches<Real> &patches,
                             const double bound)
  {
    const Vector u = wavy(discretization, 0.03, 2), x = wavy(discretization, 1, 7);
    const Elasticity elasticity(discretization, materials);
    FlatElasticity<Real> flat(patches, materials);
    const std::vector<Real> U = entries_of<Real>(u), X = entries_of<Real>(x);
    std::vector<Real> Y(U.size()), blocks(3 * U.size());
    flat.set_state({U.data(), U.size()});
    Vector assembled = discretization.make_vector();

    EXPECT_NEAR(flat.energy() / elasticity.energy(u), 1, bound);
    EXPECT_NEAR(flat.min_jacobian(), elasticity.min_jacobian(u), bound);

    elasticity.add_residual(u, assembled);
    flat.residual({Y.data(), Y.size()});
    EXPECT_LT(relative_difference(as_vector(Y, u), assembled), bound);

    BlockMatrix K(discretization.partitioner(), elasticity.couplings());
    elasticity.add_tangent(u, K);
    K.compress();
    K.vmult(assembled, x);
    flat.vmult({Y.data(), Y.size()}, {X.data(), X.size()});
    EXPECT_LT(relative_difference(as_vector(Y, u), assembled), bound);

    flat.diagonal({blocks.data(), blocks.size()});
    expect_diagonal_blocks(K, bound, [&](const unsigned int node, const int a, const int b) {
      return blocks[9 * node + 3 * a + b];
    });
  }

  template <class Real>
  void expect_flat_agreement(const Discretization &discretization,
                             const std::vector<Material> &materials,
                             const double bound)
  {
    expect_flat_agreement(discretization, materials, FlatPatches<Real>(discretization), bound);
  }

  struct Case
  {
    const char *name, *type, *method;
    unsigned int cells, degree, surface_refinement;
  };

  class FlatElasticityOf : public ::testing::TestWithParam<Case>
  {
  };

  TEST_P(FlatElasticityOf, IsTheAssembledOne)
  {
    const Case &c   = GetParam();
    const Problem p = problem(c.type, c.method, c.cells, c.degree, c.surface_refinement);
    for (const std::string &law : all_laws)
    {
      SCOPED_TRACE(law);
      expect_flat_agreement<double>(*p.discretization, {Material(law, 5000, 0.3)}, 1e-12);
      expect_flat_agreement<float>(*p.discretization, {Material(law, 5000, 0.3)}, 1e-5);
    }
  }

  INSTANTIATE_TEST_SUITE_P(AllMethods,
                           FlatElasticityOf,
                           ::testing::Values(Case{"tetrahedra", "cylinder", "tetrahedra", 4, 1, 0},
                                             Case{"tetrahedra_2", "sphere", "tetrahedra", 4, 2, 0},
                                             Case{"weighted_2", "sphere", "weighted cell", 4, 2, 0},
                                             Case{"finite", "sphere", "finite cell", 4, 1, 0},
                                             Case{"hanging", "sphere", "weighted cell", 6, 1, 1}),
                           [](const auto &test) { return std::string(test.param.name); });

  // Batches are of one material, and cells of two share nodes.
  TEST(FlatPatches, MayHaveSeveralMaterials)
  {
    UnitCells lattice({{3, 2, 2}}, 2);
    for (unsigned int i = 0; i < lattice.cells.size(); i += 2)
      lattice.cells[i].labels = {1};
    expect_flat_agreement<double>(
      lattice, {Material("Neo-Hookean", 5000, 0.3), Material("linear", 300, 0.45)}, 1e-12);
  }

  TEST(FlatPatches, GiveTheSameForAnyNumberOfThreads)
  {
    const Problem p = problem("sphere", "weighted cell", 6);
    const FlatPatches<double> patches(*p.discretization);
    const std::vector<double> x = entries_of<double>(wavy(*p.discretization, 0.03, 3));
    std::vector<double> y(x.size()), alone;
    const int n_threads = omp_get_max_threads();
    for (const int n : {1, 3})
    {
      omp_set_num_threads(n);
      FlatElasticity<double> flat(patches, {Material("Neo-Hookean", 5000, 0.3)});
      flat.set_state({x.data(), x.size()});
      flat.vmult({y.data(), y.size()}, {x.data(), x.size()});
      if (n == 1)
        alone = y;
      EXPECT_EQ(y, alone);
    }
    omp_set_num_threads(n_threads);
  }

  TEST(FlatPatches, RefuseInvertedPoints)
  {
    const UnitCells lattice({{2, 2, 1}}, 2);
    const FlatPatches<float> patches(lattice);
    FlatElasticity<float> flat(patches, {Material("Neo-Hookean", 5000, 0.3)});
    std::vector<float> mirrored(3 * lattice.node_positions().size());
    for (unsigned int node = 0; node < lattice.node_positions().size(); ++node)
      mirrored[3 * node] = -2 * lattice.node_positions()[node][0];
    EXPECT_THROW(flat.set_state({mirrored.data(), mirrored.size()}), InvertedPoint);
  }

  /// Unit cells of which some points have other nodes, weights and gradients.
  class ChangedCells : public UnitCells
  {
  public:
    const std::vector<unsigned int> rows{5, 70, 200, 201};
    const double weight = 0.1;
    std::vector<unsigned int> nodes{3, 17, 21, 40, 41, 55, 7, 30, 11};
    std::vector<double> gradients; // (nodes, 3)

    ChangedCells() : UnitCells({{4, 3, 3}}, 2)
    {
      table_.resize(1, nodes.size());
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
        {
          gradients.push_back(0.05 * std::sin(1 + i * i + 7 * d));
          table_.gradients[d * nodes.size() + i] = gradients.back();
        }
      for (const unsigned int row : rows)
        cells[row / 8].weights[row % 8] = 0;
    }

    unsigned int n_patches() const override
    {
      return cells.size() + rows.size();
    }
    Patch patch(const unsigned int i, PatchStorage &storage) const override
    {
      if (i < cells.size())
        return UnitCells::patch(i, storage);
      return {{nodes.data(), nodes.size()}, {&weight, 1}, &table_, {cells[0].labels.data(), 1}};
    }

  private:
    ShapeTable table_;
  };

  TEST(FlatElasticity, IsTheAssembledOneAfterRowsHaveChanged)
  {
    const UnitCells cells({{4, 3, 3}}, 2);
    const ChangedCells changed;
    FlatPatches<double> patches(cells, FlatPatches<double>::pack_width, 4);
    for (const unsigned int row : changed.rows)
      ASSERT_TRUE(patches.change(row, changed.weight, changed.nodes, changed.gradients));
    expect_flat_agreement(changed, {Material("Neo-Hookean", 5000, 0.3)}, patches, 1e-12);
  }
} // namespace
