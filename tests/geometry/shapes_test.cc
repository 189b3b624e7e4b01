// SPDX-License-Identifier: LGPL-2.1-or-later
// Analytic bodies: volumes, parts of boxes and classification.

#include "shape_cases.h"

#include <softcell/geometry/shape.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace softcell;
using softcell::testing::ShapeCase;
using softcell::testing::shapes;

namespace
{
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
