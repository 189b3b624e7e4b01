// SPDX-License-Identifier: LGPL-2.1-or-later
// The finite cell rule against exact volumes and moments.

#include <softcell/quadrature/finite_cell.h>

#include <gtest/gtest.h>

#include <numeric>

#include "simple_bodies.h"

namespace softcell
{
  namespace
  {
    const Box cell({Point(-0.2, 0.1, 0), Point(1.8, 1.1, 4)});
    const Ball ball(0.9, Point(0.1, 0.3, 1.1));

    double sum(const std::vector<double> &v)
    {
      return std::accumulate(v.begin(), v.end(), 0.);
    }

    // Integral of x^a over [l, u].
    double monomial(const unsigned int a, const double l, const double u)
    {
      return (std::pow(u, a + 1) - std::pow(l, a + 1)) / (a + 1);
    }
  } // namespace

  TEST(FiniteCell, VolumeOfAnEighthOfABallConverges)
  {
    const Ball eighth(1);
    const double exact = M_PI / 6;
    double previous    = 1;
    for (unsigned int levels = 1; levels <= 5; ++levels)
    {
      FiniteCell rule({levels, 0}, 1, eighth);
      const double error = std::abs(rule.add(Box({Point(), Point(1, 1, 1)})) - exact) / exact;
      // the cut leaves lie within their diagonal of the sphere
      EXPECT_LT(error, 3 * std::sqrt(3.) * std::pow(0.5, levels) / 4);
      EXPECT_LT(error, std::max(previous, 0.01)) << levels;
      previous = error;
    }
    EXPECT_LT(previous, 1e-3);
  }

  TEST(FiniteCell, IntegratesPolynomialsOverHalvedCellsExactly)
  {
    // three quarters along x, half along y, five eighths along z
    const Point lower = cell.get_boundary_points().first, upper(1.3, 0.6, 2.5);
    const Brick brick(Box({Point(-2, -1, -1), upper}));
    for (unsigned int degree = 1; degree <= 3; ++degree)
    {
      FiniteCell rule({3, 0}, degree, brick);
      EXPECT_NEAR(rule.add(cell), 1.5 * 0.5 * 2.5, 1e-13);
      CutPoints result;
      rule.points(0, result);
      const unsigned int a = 2 * degree + 1, b = degree, c = 2 * degree;
      double integral = 0;
      for (unsigned int q = 0; q < result.points.size(); ++q)
      {
        const Point X = cell.unit_to_real(result.points[q]);
        integral += result.weights[q] * std::pow(X[0], a) * std::pow(X[1], b) * std::pow(X[2], c);
      }
      const double exact = monomial(a, lower[0], upper[0]) * monomial(b, lower[1], upper[1]) *
                           monomial(c, lower[2], upper[2]);
      EXPECT_NEAR(integral, exact, 1e-12 * std::abs(exact)) << degree;
      // an eighth of the cell, then 1 x 2 x 2 leaves of 1/64, then 6 x 4 x 1 of 1/512
      EXPECT_EQ(result.points.size(), (1 + 4 + 24) * std::pow(degree + 1, 3));
    }
  }

  TEST(FiniteCell, KeepsOnlyPointsOfTheBody)
  {
    FiniteCell rule({3, 0}, 2, ball);
    const double volume = rule.add(cell);
    CutPoints result;
    rule.points(0, result);
    EXPECT_NEAR(sum(result.weights), volume, 1e-13);
    EXPECT_EQ(result.labels, std::vector<unsigned char>{0});
    for (unsigned int q = 0; q < result.points.size(); ++q)
    {
      EXPECT_TRUE(ball.contains(cell.unit_to_real(result.points[q])));
      EXPECT_GT(result.weights[q], 0);
    }
  }

  TEST(FiniteCell, TellsCellsAndLabelsApart)
  {
    const Brick two(Box({Point(0, 0, 0), Point(4, 1, 1)}), 1.25);
    FiniteCell rule({2, 0}, 1, two);
    const Box first({Point(-1, 0, 0), Point(1, 1, 1)}), second({Point(1, 0, 0), Point(2, 2, 1)});
    EXPECT_NEAR(rule.add(first), 1, 1e-14);
    EXPECT_NEAR(rule.add(second), 1, 1e-14);
    CutPoints result;
    rule.points(1, result);
    ASSERT_EQ(result.labels.size(), result.points.size());
    for (unsigned int q = 0; q < result.points.size(); ++q)
      EXPECT_EQ(result.labels[q], second.unit_to_real(result.points[q])[0] > 1.25);
    rule.points(0, result);
    EXPECT_NEAR(sum(result.weights), 1, 1e-14);
    EXPECT_EQ(result.labels.size(), 1u);
  }
} // namespace softcell
