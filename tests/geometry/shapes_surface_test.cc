// SPDX-License-Identifier: LGPL-2.1-or-later
// Analytic bodies: the triangles of the boundary.

#include "shape_cases.h"

#include <softcell/geometry/surface.h>

#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

#include <functional>
#include <map>

using namespace softcell;
using softcell::testing::ShapeCase;
using softcell::testing::shapes;

/// By the divergence theorem, and with the boundary's own normals where it is curved. Of the kinks
/// in how a cylinder's ends are stretched, quadrature sees a tenth.
TEST(ShapesSurface, TrianglesStandForTheTrueBoundary)
{
  const dealii::QWitherdenVincentSimplex<2> rule(3);
  for (const ShapeCase &shape : shapes())
  {
    const Surface &surface = shape.body->surface();
    double area = 0, flux = 0;
    Direction normal;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto [a, b, c] = surface.corners(t);
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const auto &xi        = rule.point(q);
        const BoundaryPoint p = shape.body->on_boundary(a + xi[0] * (b - a) + xi[1] * (c - a),
                                                        surface.normal(t), surface.patches()[t]);
        const double weight   = 2 * rule.weight(q) * surface.area(t) * p.stretch;
        area += weight;
        flux += weight * (p.X * p.normal);
        normal += weight * p.normal;
        EXPECT_NEAR(p.normal.norm(), 1, 1e-14);
        EXPECT_TRUE(shape.body->contains(p.X - 1e-9 * p.normal)) << shape.name;
        EXPECT_FALSE(shape.body->contains(p.X + 1e-9 * p.normal)) << shape.name;
      }
    }
    EXPECT_NEAR(area / shape.area, 1, 4e-5) << shape.name;
    EXPECT_NEAR(flux / (3 * shape.volume), 1, 4e-5) << shape.name;
    EXPECT_LT(normal.norm(), 1e-12 * area) << shape.name;
  }
}

TEST(ShapesSurface, SurfaceIsClosedAndEnclosesTheVolume)
{
  for (const ShapeCase &shape : shapes())
  {
    const Surface &surface = shape.body->surface();
    std::map<std::pair<int, int>, int> edges;
    Direction normals;
    double volume = 0, area = 0;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto [a, b, c]   = surface.corners(t);
      const Direction vector = 0.5 * cross_product_3d(b - a, c - a);
      normals += vector;
      area += vector.norm();
      volume += vector * (a + b + c) / 9;
      EXPECT_GT(vector.norm(), 0) << shape.name;
      const auto &corner = surface.triangles()[t];
      for (unsigned int e = 0; e < 3; ++e)
      {
        ++edges[{corner[e], corner[(e + 1) % 3]}];
        --edges[{corner[(e + 1) % 3], corner[e]}];
      }
    }
    for (const auto &[edge, balance] : edges)
      ASSERT_EQ(balance, 0) << shape.name << ": open edge";
    EXPECT_LT(normals.norm(), 1e-12 * area) << shape.name;
    const double least = shape.flat ? 1 - 1e-12 : 1 - 1e-3, most = 1 + 1e-12;
    EXPECT_GT(volume / shape.volume, least) << shape.name;
    EXPECT_LT(volume / shape.volume, most) << shape.name;
    EXPECT_GT(area / shape.area, least) << shape.name;
    EXPECT_LT(area / shape.area, most) << shape.name;
  }
}

TEST(ShapesSurface, PatchesAreTheFaces)
{
  const auto count = [](const Body &body, const std::function<bool(const Point &)> &on_patch,
                        unsigned int patch) {
    const Surface &surface = body.surface();
    unsigned int n         = 0;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto [a, b, c] = surface.corners(t);
      EXPECT_EQ(surface.patches()[t] == patch, on_patch(a) && on_patch(b) && on_patch(c));
      n += surface.patches()[t] == patch;
    }
    return n;
  };
  const auto cylinder = make_cylinder(0.05, 0.6), box = make_box(Point(1, 2, 3));
  EXPECT_GT(count(
              *cylinder, [](const Point &X) { return X[2] == 0; }, 1),
            0u);
  EXPECT_GT(count(
              *cylinder, [](const Point &X) { return X[2] == 0.6; }, 2),
            0u);
  for (unsigned int d = 0; d < dim; ++d)
  {
    EXPECT_EQ(count(
                *box, [&](const Point &X) { return X[d] == 0; }, 2 * d),
              512u);
    EXPECT_EQ(count(
                *box, [&](const Point &X) { return X[d] == d + 1; }, 2 * d + 1),
              512u);
  }
}
