// SPDX-License-Identifier: LGPL-2.1-or-later
// Conforming elements: exactness, regions, places and pictures, on any number of ranks.

#include "elements_on_a_box.h"

#include <cmath>

namespace softcell
{
  using namespace elements_on_a_box;

  namespace
  {
    /// A polynomial of full degree p, and its gradient.
    double polynomial(const Point &X, const unsigned int p)
    {
      return std::pow(X[0] + 2 * X[1] - X[2] + 0.3, p);
    }
    Direction slope(const Point &X, const unsigned int p)
    {
      return p * std::pow(X[0] + 2 * X[1] - X[2] + 0.3, p - 1.) * Direction({1, 2, -1});
    }

    /// Value and gradient of that polynomial's interpolant from shapes at a point.
    std::pair<double, Direction> interpolant(const Fitted &fitted,
                                             const View<const unsigned int> &nodes,
                                             const double *N,
                                             const double *dN)
    {
      std::pair<double, Direction> result;
      for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const double u = polynomial(fitted.node_positions()[nodes[i]], fitted.degree());
        result.first += N[i] * u;
        for (unsigned int d = 0; d < 3; ++d)
          result.second[d] += dN[d * nodes.size() + i] * u;
      }
      return result;
    }

    View<const unsigned int> view(const std::vector<unsigned int> &nodes)
    {
      return View<const unsigned int>(nodes.data(), nodes.size());
    }
  } // namespace

  class FittedElements : public testing::TestWithParam<Element>
  {
  };

  TEST_P(FittedElements, ReproducePolynomialsOfTheirDegree)
  {
    const Fitted fitted = on_box(GetParam());
    PatchStorage storage;
    std::vector<Point> points;
    for (unsigned int i = 0; i < fitted.n_patches(); ++i)
    {
      const Patch patch = fitted.patch(i, storage);
      fitted.patch_points(i, points);
      ASSERT_EQ(points.size(), patch.n_points());
      for (unsigned int q = 0; q < patch.n_points(); ++q)
      {
        const auto [u, gradient] =
          interpolant(fitted, patch.nodes, patch.shapes->value(q), patch.shapes->gradient(q));
        EXPECT_NEAR(u, polynomial(points[q], fitted.degree()), 1e-11);
        EXPECT_NEAR((gradient - slope(points[q], fitted.degree())).norm(), 0, 1e-10);
      }
    }
    for (const SurfacePatch &patch : fitted.surface_patches(everywhere))
      for (unsigned int q = 0; q < patch.weights.size(); ++q)
      {
        const auto [u, gradient] =
          interpolant(fitted, view(patch.nodes), patch.shapes.value(q), patch.shapes.gradient(q));
        EXPECT_NEAR(u, polynomial(patch.points[q], fitted.degree()), 1e-11);
        EXPECT_NEAR((gradient - slope(patch.points[q], fitted.degree())).norm(), 0, 1e-10);
        EXPECT_NEAR(patch.cell_size, 0.5, 1e-12);
      }
  }

  TEST_P(FittedElements, KnowTheNodesOfARegionOnAllRanks)
  {
    const Fitted fitted = on_box(GetParam());
    const auto nodes    = fitted.nodes_on(Region("base", "z < 1e-9"));
    ASSERT_TRUE(nodes);
    std::vector<unsigned int> expected;
    for (unsigned int i = 0; i < fitted.node_positions().size(); ++i)
      if (std::abs(fitted.node_positions()[i][2]) < 1e-9)
        expected.push_back(i);
    EXPECT_EQ(*nodes, expected);
    unsigned int owned = 0;
    for (const unsigned int i : *nodes)
      owned += i < fitted.n_owned_nodes();
    EXPECT_EQ(sum(owned), (4 * GetParam().degree + 1) * (2 * GetParam().degree + 1));
  }

  TEST_P(FittedElements, FindPointsInsideAndNearby)
  {
    const Fitted fitted = on_box(GetParam(), MPI_COMM_SELF);
    for (const Point &X :
         {Point(0.21, 0.43, 1.1), Point(0, 0, 0), Point(2, 1, 1.5), Point(1, 0.5, 0.5)})
    {
      const auto found = fitted.shapes_at(X, 0);
      ASSERT_TRUE(found) << X;
      EXPECT_EQ(found->claim.distance, 0);
      const auto [u, gradient] =
        interpolant(fitted, view(found->nodes), found->values.data(), found->gradients.data());
      EXPECT_NEAR(u, polynomial(X, fitted.degree()), 1e-11);
      EXPECT_NEAR((gradient - slope(X, fitted.degree())).norm(), 0, 1e-10);
    }
    const Point outside(2.1, 0.3, 0.7);
    EXPECT_FALSE(fitted.shapes_at(outside, 0.05));
    const auto found = fitted.shapes_at(outside, 0.5);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->claim.distance, 0.1, GetParam().tetrahedra ? 0.05 : 1e-12);
    const double u =
      interpolant(fitted, view(found->nodes), found->values.data(), found->gradients.data()).first;
    EXPECT_NEAR(u, polynomial(outside, fitted.degree()), 1e-10);
  }

  TEST_P(FittedElements, AreFoundByOneRankAtLeast)
  {
    const Fitted fitted = on_box(GetParam());
    for (const Point &X : {Point(0.21, 0.43, 1.1), Point(1.7, 0.9, 0.1)})
      EXPECT_GE(sum(fitted.shapes_at(X, 1e-9).has_value()), 1);
    for (unsigned int d = 0; d < 3 && fitted.n_patches() > 0; ++d)
    {
      EXPECT_GE(fitted.owned_box().lower_bound(d), -1e-12);
      EXPECT_LE(fitted.owned_box().upper_bound(d), size[d] + 1e-12);
    }
  }

  TEST_P(FittedElements, AreDrawnAsVtkOrdersThem)
  {
    const Fitted fitted    = on_box(GetParam());
    const DrawnCells cells = fitted.drawn_cells();
    ASSERT_EQ(cells.types.size(), fitted.n_patches());
    // Edges in the order of VTK's file format.
    using Edges          = std::vector<std::array<unsigned int, 2>>;
    const Edges edges    = GetParam().tetrahedra
                             ? Edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}
                             : Edges{{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6},
                                  {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    const unsigned int p = GetParam().degree, corners = GetParam().tetrahedra ? 4 : 8;
    for (unsigned int cell = 0; cell < fitted.n_patches(); ++cell)
    {
      const auto point = [&](const unsigned int i) {
        return cells.points[cells.connectivity[cells.offsets[cell] + i]];
      };
      EXPECT_EQ(cells.patches[cell], cell);
      const Direction up = point(corners / 2 + (corners == 4)) - point(0);
      EXPECT_GT(
        dealii::cross_product_3d(point(1) - point(0), point(corners == 4 ? 2 : 3) - point(0)) * up,
        0);
      for (unsigned int e = 0; e < edges.size(); ++e)
        for (unsigned int i = 1; i < p; ++i)
        {
          const Point expected =
            point(edges[e][0]) + i / double(p) * (point(edges[e][1]) - point(edges[e][0]));
          EXPECT_LT(point(corners + e * (p - 1) + i - 1).distance(expected), 1e-12);
        }
    }
    for (unsigned int i = 0; i < cells.points.size(); ++i)
      EXPECT_EQ(cells.shapes[i].nodes, std::vector<unsigned int>{i});
  }

  INSTANTIATE_TEST_SUITE_P(Box, FittedElements, all_elements, element_name);
} // namespace softcell
