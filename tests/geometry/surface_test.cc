// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures, inside test, nearest point and clipping of triangle surfaces.

#include <softcell/geometry/surface.h>

#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapes.h"

using namespace softcell;
using namespace softcell::testing;

namespace
{
  /// Winding number of a closed surface around X: the sum of solid angles (van Oosterom and
  /// Strackee 1983) / 4 pi.
  double winding_number(const Surface &surface, const Point &X)
  {
    double angle = 0;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto c      = surface.corners(t);
      const Direction a = c[0] - X, b = c[1] - X, d = c[2] - X;
      const double A = a.norm(), B = b.norm(), D = d.norm();
      angle += 2 * std::atan2(a * cross_product_3d(b, d),
                              A * B * D + (a * b) * D + (b * d) * A + (d * a) * B);
    }
    return angle / (4 * dealii::numbers::PI);
  }

  struct RandomPoint
  {
    Point operator()(const double low, const double high)
    {
      std::uniform_real_distribution<double> x(low, high);
      return Point(x(generator), x(generator), x(generator));
    }
    std::mt19937 generator;
  };
} // namespace

TEST(Surface, MeasuresOfTetrahedronAndSphere)
{
  const Surface simplex = tetrahedron();
  EXPECT_NEAR(simplex.volume(), 1. / 6, 1e-15);
  EXPECT_NEAR(simplex.area(), 1.5 + std::sqrt(3.) / 2, 1e-14);
  EXPECT_NEAR(simplex.area(3), std::sqrt(3.) / 2, 1e-15);
  EXPECT_NEAR(simplex.normal(3)[0], 1 / std::sqrt(3.), 1e-15);
  EXPECT_EQ(simplex.patches(), std::vector<unsigned int>(4, 0));

  const Surface ball = sphere(4, 0.5, Point(7, 8, 9));
  const auto box     = ball.bounding_box();
  for (unsigned int d = 0; d < 3; ++d)
    EXPECT_DOUBLE_EQ(box.side_length(d), 1);
  EXPECT_NEAR(ball.volume(), dealii::numbers::PI / 6, 4e-3); // an inscribed polyhedron
  EXPECT_LT(ball.volume(), dealii::numbers::PI / 6);

  Direction normals;
  double moments = 0;
  for (unsigned int t = 0; t < ball.triangles().size(); ++t)
  {
    const auto c      = ball.corners(t);
    const Direction n = ball.normal(t) * ball.area(t);
    normals += n;
    moments += (c[0] + (c[1] + Direction(c[2]))) * n / 3;
  }
  EXPECT_LT(normals.norm(), 1e-13);
  EXPECT_NEAR(moments, 3 * ball.volume(), 1e-12);
}

TEST(Surface, ContainsAgreesWithWindingNumber)
{
  const Surface ball = sphere(2);
  RandomPoint random;
  unsigned int n_inside = 0;
  for (unsigned int i = 0; i < 2000; ++i)
  {
    const Point X        = random(-1.1, 1.1);
    const double winding = winding_number(ball, X);
    ASSERT_EQ(ball.contains(X), winding > 0.5) << X;
    n_inside += winding > 0.5;
  }
  EXPECT_GT(n_inside, 500u);
  EXPECT_LT(n_inside, 1500u);
}

TEST(Surface, ContainsHoldsBelowVerticesAndEdges)
{
  // Every line along z through these points meets vertices, edges, or whole vertical triangles.
  const Surface ball = sphere(3);
  for (const Point &vertex : ball.vertices())
    for (const double z : {-2., -1e-3, 0., 1e-3, 2.})
    {
      const Point X(vertex[0], vertex[1], z);
      if (const double winding = winding_number(ball, X); std::abs(winding - 0.5) > 0.4)
      {
        EXPECT_EQ(ball.contains(X), winding > 0.5) << X;
      }
    }

  const Surface cube = brick();
  for (const double x : {-0.5, 0., 0.25, 0.5, 1., 1.5})
    for (const double y : {-0.5, 0., 0.25, 0.5, 1., 1.5})
    {
      const bool within  = x > 0 && x < 1 && y > 0 && y < 1,
                 outside = x < 0 || x > 1 || y < 0 || y > 1;
      EXPECT_FALSE(cube.contains(Point(x, y, -0.1)));
      EXPECT_FALSE(cube.contains(Point(x, y, 1.1)));
      if (within || outside)
      {
        EXPECT_EQ(cube.contains(Point(x, y, 0.5)), within);
      }
    }
}

TEST(Surface, ContainsOfSliversBesideVerticalWalls)
{
  // A cube whose walls lean by a few roundings, at a place where coordinates have few digits left.
  const double tilt  = 1e-13;
  const Point shift  = Point(1000, 1000, 1000);
  const Surface cube = brick();
  std::vector<Point> vertices;
  for (const Point &X : cube.vertices())
    vertices.emplace_back(shift + Direction({X[0] + tilt * X[2], X[1] - tilt * X[2], X[2]}));
  const Surface leaning(vertices, cube.triangles());
  RandomPoint random;
  for (unsigned int i = 0; i < 1000; ++i)
  {
    const Point X = random(0, 1);
    EXPECT_TRUE(leaning.contains(shift + Direction({X[0], X[1], X[2]}) * (1 - 1e-11) +
                                 Direction({5e-12, 5e-12, 5e-12})));
    EXPECT_FALSE(leaning.contains(shift + Direction({0, X[1], X[2] + 1.0001})));
    EXPECT_FALSE(leaning.contains(shift + Direction({X[0], 1, -X[2] - 1e-4})));
  }
}

TEST(Surface, TrianglesInBoxAreThoseThatClipToSomething)
{
  const Surface ball = sphere(3);
  RandomPoint random;
  for (unsigned int i = 0; i < 200; ++i)
  {
    const Point lower = random(-1, 1);
    const Box box({lower, lower + (random(0.01, 0.5) - Point())});

    std::vector<unsigned int> expected;
    for (unsigned int t = 0; t < ball.triangles().size(); ++t)
      if (!clip(ball.corners(t), box).empty())
        expected.push_back(t);
    auto found = ball.triangles_in(box);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(ball.meets(box), !expected.empty());
  }
}

TEST(Surface, PiecesOfTrianglesInAGridAddUpToTheArea)
{
  const Surface ball = sphere(3, 0.9);
  double area        = 0;
  for_each_cell(Box({Point(-1.01, -1.03, -1.02), Point(1.04, 1.01, 1.05)}), 7,
                [&](const Box &cell) {
                  for (const unsigned int t : ball.triangles_in(cell))
                  {
                    const auto piece = clip(ball.corners(t), cell);
                    ASSERT_LE(piece.size(), 9u);
                    for (const Point &X : piece)
                      ASSERT_TRUE(cell.point_inside(X, 1e-12));
                    area += polygon_area(piece);
                  }
                });
  EXPECT_NEAR(area, ball.area(), 1e-12);
}

TEST(Surface, ClippingKeepsOrientationAndGivesKnownPieces)
{
  const std::array<Point, 3> triangle = {Point(0, 0, 0.5), Point(2, 0, 0.5), Point(0, 2, 0.5)};
  const auto piece                    = clip(triangle, Box({Point(0, 0, 0), Point(1.5, 1.5, 1)}));
  EXPECT_EQ(piece.size(), 5u);
  EXPECT_NEAR(polygon_area(piece), 2 - 2 * 0.125, 1e-15);
  EXPECT_GT(cross_product_3d(piece[1] - piece[0], piece[2] - piece[0])[2], 0);
  EXPECT_TRUE(clip(triangle, Box({Point(0, 0, 0.6), Point(1, 1, 1)})).empty());
  EXPECT_TRUE(clip(triangle, Box({Point(1.1, 1.1, 0), Point(2, 2, 1)})).empty());
}

TEST(Surface, NearestPointOfACube)
{
  const Surface cube = brick(Point(-1, -1, -1), Point(1, 1, 1));
  RandomPoint random;
  for (unsigned int i = 0; i < 1000; ++i)
  {
    const Point X  = random(-2, 2);
    double outside = 0, depth = 1;
    for (unsigned int d = 0; d < 3; ++d)
    {
      outside += std::pow(std::max(std::abs(X[d]) - 1, 0.), 2);
      depth = std::min(depth, 1 - std::abs(X[d]));
    }
    const auto [point, triangle] = cube.nearest(X);
    EXPECT_NEAR(X.distance(point), depth > 0 ? depth : std::sqrt(outside), 1e-13);
    EXPECT_NEAR((point - cube.corners(triangle)[0]) * cube.normal(triangle), 0, 1e-13);
  }
}

TEST(Surface, NearestPointAmongManyTriangles)
{
  const Surface ball = sphere(4);
  RandomPoint random;
  for (unsigned int i = 0; i < 200; ++i)
  {
    // Each facet is seen by its own plane's distance, which is the distance of an inner point to
    // its nearest facet.
    const Point X   = random(-0.5, 0.5);
    double distance = 1;
    for (unsigned int t = 0; t < ball.triangles().size(); ++t)
      distance = std::min(distance, (ball.corners(t)[0] - X) * ball.normal(t));
    EXPECT_NEAR(X.distance(ball.nearest(X).first), distance, 1e-13);
  }
}
