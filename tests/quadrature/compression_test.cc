// SPDX-License-Identifier: LGPL-2.1-or-later
// Moments of many points against those of the few that replace them.

#include <softcell/quadrature/compression.h>

#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace softcell
{
  namespace
  {
    struct Rule
    {
      std::vector<Point> points;
      std::vector<double> weights;
    };

    /// The points of n^3 boxes of the unit cube that lie in a body.
    Rule many_points(const std::function<bool(const Point &)> &is_inside,
                     const unsigned int degree,
                     const unsigned int n)
    {
      const dealii::QIterated<3> all(dealii::QGauss<1>(degree + 1), n);
      Rule rule;
      for (unsigned int q = 0; q < all.size(); ++q)
        if (is_inside(all.point(q)))
        {
          rule.points.push_back(all.point(q));
          rule.weights.push_back(all.weight(q));
        }
      return rule;
    }

    double volume(const Rule &rule)
    {
      return std::accumulate(rule.weights.begin(), rule.weights.end(), 0.);
    }

    double moment(const Rule &rule, const int a, const int b, const int c)
    {
      double sum = 0;
      for (unsigned int q = 0; q < rule.points.size(); ++q)
        sum += rule.weights[q] * std::pow(rule.points[q][0], a) * std::pow(rule.points[q][1], b) *
               std::pow(rule.points[q][2], c);
      return sum;
    }

    /// Largest difference of the integrals of products of trilinear gradients, per volume:
    /// x^a y^b z^c times x^d y^e z^f, of which each factor lacks one coordinate.
    double stiffness_defect(const Rule &few, const Rule &many)
    {
      double defect = 0;
      for (int i = 0; i < 64; ++i)
      {
        const int a = i & 1, b = i >> 1 & 1, c = i >> 2 & 1, d = i >> 3 & 1, e = i >> 4 & 1,
                  f = i >> 5;
        if (a * b * c == 0 && d * e * f == 0)
          defect = std::max(
            defect, std::abs(moment(few, a + d, b + e, c + f) - moment(many, a + d, b + e, c + f)));
      }
      return defect / volume(many);
    }

    void expect_positive_and_inside(const Rule &few, const Rule &many)
    {
      for (const double w : few.weights)
        EXPECT_GT(w, 0.0999 * volume(many) / few.weights.size());
      for (unsigned int d = 0; d < 3; ++d)
      {
        const auto less = [d](const Point &p, const Point &q) { return p[d] < q[d]; };
        const auto [lower, upper] =
          std::minmax_element(many.points.begin(), many.points.end(), less);
        for (const Point &p : few.points)
        {
          EXPECT_GE(p[d], (*lower)[d]);
          EXPECT_LE(p[d], (*upper)[d]);
        }
      }
    }

    std::vector<std::function<bool(const Point &)>> bodies()
    {
      std::vector<std::function<bool(const Point &)>> result;
      const std::vector<Direction> normals = {Direction({1, 0, 0}), Direction({0, 0.6, 0.8}),
                                              Direction({0.36, -0.48, 0.8})};
      for (const Direction &n : normals)
        for (const double d : {-0.35, -0.1, 0.02, 0.3})
          result.emplace_back([=](const Point &p) { return n * (p - Point(0.5, 0.5, 0.5)) < d; });
      // all but a corner, a corner, and two corners with nothing between them
      result.emplace_back([](const Point &p) { return p.norm() > 0.3; });
      result.emplace_back([](const Point &p) { return p.norm() < 0.4; });
      result.emplace_back(
        [](const Point &p) { return p.norm() < 0.4 || p.distance(Point(1, 1, 1)) < 0.5; });
      return result;
    }
  } // namespace

  TEST(Compression, EightPointsHaveTheStiffnessOfMany)
  {
    const Compression compression(1);
    for (const auto &body : bodies())
    {
      const Rule many = many_points(body, 1, 8);
      Rule few        = many;
      EXPECT_LT(compression.compress(few.points, few.weights), 1e-9);
      ASSERT_EQ(few.points.size(), 8u);
      ASSERT_EQ(few.weights.size(), 8u);
      EXPECT_LT(stiffness_defect(few, many), 1e-10);
      expect_positive_and_inside(few, many);
    }
  }

  TEST(Compression, HigherDegreesKeepTheMomentsOfGradients)
  {
    const auto half   = [](const Point &p) { return p[0] + 0.7 * p[1] - 0.4 * p[2] < 0.6; };
    const auto corner = [](const Point &p) { return p.norm() < 0.7; };
    const auto others = [](const Point &p) { return p.norm() > 0.5; };
    struct Case
    {
      unsigned int degree, n;
      std::function<bool(const Point &)> body;
    };
    for (const auto &[degree, n, body] :
         {Case{2, 4, half}, {2, 4, corner}, {2, 4, others}, {3, 2, others}})
    {
      const Compression compression(degree);
      const Rule many = many_points(body, degree, n);
      Rule few        = many;
      EXPECT_LT(compression.compress(few.points, few.weights), 0.1);
      ASSERT_EQ(few.points.size(), std::pow(degree + 1, 3));
      expect_positive_and_inside(few, many);
      for (unsigned int a = 0; a <= degree; ++a)
        for (unsigned int b = 0; b <= degree; ++b)
          for (unsigned int c = 0; c <= degree; ++c)
            if (std::min({a, b, c}) < degree)
            {
              EXPECT_NEAR(moment(few, a, b, c), moment(many, a, b, c), 1e-9) << a << b << c;
            }
    }
  }

  /// Nearly all in one corner, the rest in the opposite one. There the integrals of x, y, z are
  /// those of their products, so all points of a rule must be in one of both corners; but then a
  /// single one weighs too much in the second.
  TEST(Compression, KeepsThePointsWhereNoFewHaveTheirMoments)
  {
    for (unsigned int degree = 1; degree <= 2; ++degree)
    {
      Rule many = {std::vector<Point>(1000), std::vector<double>(1003, 1e-3)};
      many.points.resize(1003, Point(1, 1, 1));
      Rule kept = many;
      EXPECT_EQ(Compression(degree).compress(kept.points, kept.weights), 0);
      EXPECT_EQ(kept.points, many.points);
      EXPECT_EQ(kept.weights, many.weights);
    }
  }

  TEST(Compression, KeepsFewPointsAsTheyAre)
  {
    const Compression compression(1);
    const Rule rule = many_points([](const Point &) { return true; }, 1, 1);
    Rule kept       = rule;
    EXPECT_EQ(compression.compress(kept.points, kept.weights), 0);
    EXPECT_EQ(kept.points, rule.points);
    EXPECT_EQ(kept.weights, rule.weights);
  }

  /// What a sliver along a face or an edge shows: one layer, one row.
  TEST(Compression, TakesPointsOfAPlaneAndOfALine)
  {
    const Compression compression(1);
    for (const bool is_line : {false, true})
    {
      const Rule many =
        many_points([=](const Point &p) { return p[2] < 0.05 && (!is_line || p[1] < 0.05); }, 1, 8);
      Rule few = many;
      EXPECT_LT(compression.compress(few.points, few.weights), 1e-9);
      EXPECT_EQ(few.points.size(), 8u);
      EXPECT_LT(stiffness_defect(few, many), 1e-10);
      expect_positive_and_inside(few, many);
    }
  }
} // namespace softcell
