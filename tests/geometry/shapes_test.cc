// SPDX-License-Identifier: LGPL-2.1-or-later
// Analytic bodies: volumes, parts of boxes, classification and the triangles of the boundary.

#include <softcell/geometry/shape.h>
#include <softcell/geometry/shapes.h>

#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace softcell;

namespace
{
  struct ShapeCase
  {
    const char *name;
    std::shared_ptr<Body> body;
    double volume; // from a table of formulas
    double area;
    bool flat; // its triangles are the boundary itself
  };

  std::vector<ShapeCase> shapes()
  {
    const double pi = std::acos(-1.);
    return {{"box", make_box(Point(0.1, 0.2, 0.3)), 0.006, 0.22, true},
            {"cylinder", make_cylinder(0.05, 0.6), pi * 0.0015, 2 * pi * (0.03 + 0.0025), false},
            {"prism", make_hexagonal_prism(0.2, 0.1), 0.006 * std::sqrt(3.),
             0.12 + 0.12 * std::sqrt(3.), true},
            {"sphere", make_sphere(2), 32 * pi / 3, 16 * pi, false},
            {"hollow sphere", make_hollow_sphere(0.2, 0.1), 0.028 * pi / 3, 0.2 * pi, false},
            {"torus", make_torus(0.1, 0.05), 5e-4 * pi * pi, 0.02 * pi * pi, false}};
  }

  /// n^3 equal boxes that fill a box `scale` times the bounding box, around its centre.
  std::vector<Box> grid(const Box &box, const unsigned int n, const double scale = 1)
  {
    const Point centre = box.center();
    const Direction side =
      (box.get_boundary_points().second - box.get_boundary_points().first) * scale;
    const auto corner = [&](const unsigned int i, const unsigned int j, const unsigned int k) {
      return centre + Direction({side[0] * (double(i) / n - 0.5), side[1] * (double(j) / n - 0.5),
                                 side[2] * (double(k) / n - 0.5)});
    };
    std::vector<Box> boxes;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int k = 0; k < n; ++k)
          boxes.push_back(Box({corner(i, j, k), corner(i + 1, j + 1, k + 1)}));
    return boxes;
  }

  /// A random box that reaches into the bounding box.
  Box random_box(const Box &bounds, std::mt19937 &random)
  {
    std::uniform_real_distribution<> anywhere(-0.1, 1.1), size(0.02, 0.6);
    Point low, high;
    for (unsigned int d = 0; d < dim; ++d)
    {
      low[d]  = bounds.lower_bound(d) + anywhere(random) * bounds.side_length(d);
      high[d] = low[d] + size(random) * bounds.side_length(d);
    }
    return Box({low, high});
  }

  Point random_point(const Box &box, std::mt19937 &random)
  {
    std::uniform_real_distribution<> unit(0, 1);
    return box.unit_to_real(Point(unit(random), unit(random), unit(random)));
  }
} // namespace

TEST(Shapes, VolumeIsTheFormula)
{
  for (const ShapeCase &shape : shapes())
    EXPECT_NEAR(shape.body->volume() / shape.volume, 1, 1e-14) << shape.name;
}

TEST(Shapes, PartsOfAGridAddUpToTheVolume)
{
  for (const ShapeCase &shape : shapes())
    for (const double scale : {1., 1.13})
    {
      double sum = 0;
      for (const Box &box : grid(shape.body->bounding_box(), 7, scale))
        sum += shape.body->filled_volume(box);
      EXPECT_NEAR(sum / shape.volume, 1, 1e-11) << shape.name;
    }
}

/// By the divergence theorem, and with the boundary's own normals where it is curved. Of the kinks
/// in how a cylinder's ends are stretched, quadrature sees a tenth.
TEST(Shapes, TrianglesStandForTheTrueBoundary)
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

/// Splitting a box must not change what is filled of it, and points at random must find the same
/// share.
TEST(Shapes, PartOfABoxIsTheSumOfItsPartsAndMatchesSampling)
{
  std::mt19937 random(1);
  for (const ShapeCase &shape : shapes())
    for (unsigned int trial = 0; trial < 20; ++trial)
    {
      const Box box       = random_box(shape.body->bounding_box(), random);
      const double filled = shape.body->filled_volume(box);
      double sum          = 0;
      for (const Box &part : grid(box, 5))
        sum += shape.body->filled_volume(part);
      EXPECT_NEAR(filled, sum, 1e-9 * box.volume()) << shape.name << " trial " << trial;

      unsigned int hits               = 0;
      constexpr unsigned int n_points = 20000;
      for (unsigned int i = 0; i < n_points; ++i)
        hits += shape.body->contains(random_point(box, random));
      EXPECT_NEAR(filled / box.volume(), double(hits) / n_points, 0.016) << shape.name; // 4.5 sigma
    }
}

/// The octant [0, 1]^3 of the ball |X - (0, 0, 2)| < 2 moved to the ball's centre has a known cap.
TEST(Shapes, PartOfABallIsExact)
{
  const double pi = std::acos(-1.);
  const auto ball = make_sphere(2);
  EXPECT_NEAR(ball->filled_volume(Box({Point(0, 0, 2), Point(3, 3, 5)})), 4 * pi / 3, 1e-11);
  // cap of height 1
  EXPECT_NEAR(ball->filled_volume(Box({Point(-3, -3, 3), Point(3, 3, 5)})), 5 * pi / 3, 1e-11);
  EXPECT_NEAR(ball->filled_volume(Box({Point(1, -3, -1), Point(3, 3, 5)})), 5 * pi / 3, 1e-11);
}

TEST(Shapes, ClassificationAgreesWithPointsAndParts)
{
  std::mt19937 random(2);
  for (const ShapeCase &shape : shapes())
    for (const Box &box : grid(shape.body->bounding_box(), 9, 1.1))
    {
      const Side side       = shape.body->classify(box);
      const double fraction = shape.body->filled_volume(box) / box.volume();
      for (unsigned int i = 0; side != Side::cut && i < 20; ++i)
        EXPECT_EQ(shape.body->contains(random_point(box, random)), side == Side::inside)
          << shape.name;
      EXPECT_EQ(side == Side::inside, fraction > 1 - 1e-9) << shape.name << ' ' << fraction;
      EXPECT_EQ(side == Side::outside, fraction < 1e-9) << shape.name << ' ' << fraction;
    }
}

TEST(Shapes, FlushBoxesAreNotCut)
{
  const auto cylinder = make_cylinder(0.05, 0.6);
  for (unsigned int k = 0; k < 60; ++k)
  {
    const double low = 0.6 * k / 60, high = low + 0.6 / 60;
    EXPECT_EQ(cylinder->classify(Box({Point(0, 0, low), Point(0.01, 0.01, high)})), Side::inside);
  }
  EXPECT_EQ(cylinder->classify(Box({Point(0, 0, 0.6), Point(0.01, 0.01, 0.7)})), Side::outside);
  EXPECT_EQ(cylinder->classify(Box({Point(0, 0, -0.1), Point(0.01, 0.01, 0)})), Side::outside);
  EXPECT_EQ(cylinder->classify(Box({Point(0.05, -1, 0), Point(0.1, 1, 0.6)})), Side::outside);
  EXPECT_EQ(cylinder->classify(Box({Point(0, 0, 0), Point(0.03, 0.04, 0.6)})), Side::inside);

  const auto box = make_box(Point(0.3, 0.7, 0.9));
  for (const Box &cell : grid(box->bounding_box(), 7))
    EXPECT_EQ(box->classify(cell), Side::inside);
}

TEST(Shapes, SurfaceIsClosedAndEnclosesTheVolume)
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

TEST(Shapes, PatchesAreTheFaces)
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
