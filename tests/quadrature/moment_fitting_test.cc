// SPDX-License-Identifier: LGPL-2.1-or-later
// Moments, volumes and labels of moment fitting against theory and against the finite cell.

#include <softcell/quadrature/moment_fitting.h>

#include <softcell/quadrature/finite_cell.h>

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "simple_bodies.h"

namespace softcell
{
  namespace
  {
    double sum_of_weights(const CutPoints &points)
    {
      return std::accumulate(points.weights.begin(), points.weights.end(), 0.);
    }

    /// Nearly all in one corner of the unit cube, 1/512 of it in the opposite one.
    class OppositeCorners : public Brick
    {
    public:
      OppositeCorners() : Brick(Box({Point(), Point(1, 1, 1) / 16})) {}
      bool contains(const Point &X) const override
      {
        return Brick::contains(X) || rest_.contains(X);
      }
      double filled_volume(const Box &box) const override
      {
        return Brick::filled_volume(box) + rest_.filled_volume(box);
      }

    private:
      Brick rest_ = Brick(Box({Point(1, 1, 1) * 127. / 128, Point(1, 1, 1)}));
    };

    /// Integral of x^a over [lower, upper].
    double power_integral(const int a, const double lower, const double upper)
    {
      return (std::pow(upper, a + 1) - std::pow(lower, a + 1)) / (a + 1);
    }

    void expect_points_in_the_cell(const CutPoints &result, const std::size_t most)
    {
      EXPECT_LE(result.points.size(), most);
      ASSERT_EQ(result.points.size(), result.weights.size());
      for (const double w : result.weights)
        EXPECT_GT(w, 0);
      for (const Point &p : result.points)
        EXPECT_TRUE(Box({Point(), Point(1, 1, 1)}).point_inside(p, 0.));
    }
  } // namespace

  TEST(MomentFitting, IntegratesProductsOfGradientsOverHalvedCellsExactly)
  {
    // three quarters along x, half along y, five eighths along z
    const Box cell({Point(-0.2, 0.1, 0), Point(1.8, 1.1, 4)});
    const Point lower = cell.get_boundary_points().first, upper(1.3, 0.6, 2.5);
    const Brick brick(Box({Point(-2, -1, -1), upper}));
    MomentFitting rule({3}, 1, brick);
    EXPECT_NEAR(rule.add(cell), 1.5 * 0.5 * 2.5, 1e-13);
    CutPoints result;
    rule.points(0, result);
    expect_points_in_the_cell(result, 8);
    for (const auto &[a, b, c] : {std::array{0, 0, 0},
                                  {1, 0, 0},
                                  {0, 1, 0},
                                  {0, 0, 1},
                                  {1, 1, 0},
                                  {0, 1, 1},
                                  {1, 0, 1},
                                  {2, 2, 0},
                                  {0, 2, 2},
                                  {2, 1, 1},
                                  {1, 1, 2}})
    {
      double integral = 0;
      for (unsigned int q = 0; q < result.points.size(); ++q)
      {
        const Point X = cell.unit_to_real(result.points[q]);
        integral += result.weights[q] * std::pow(X[0], a) * std::pow(X[1], b) * std::pow(X[2], c);
      }
      const double exact = power_integral(a, lower[0], upper[0]) *
                           power_integral(b, lower[1], upper[1]) *
                           power_integral(c, lower[2], upper[2]);
      EXPECT_NEAR(integral, exact, 1e-9) << a << b << c;
    }
  }

  /// The cut leaves lie within their diagonal of the sphere.
  TEST(MomentFitting, HasTheVolumeAndTheCentroidOfAnEighthOfABall)
  {
    const Ball eighth(1);
    for (unsigned int levels = 2; levels <= 4; ++levels)
    {
      MomentFitting rule({levels}, 1, eighth);
      const double volume = rule.add(Box({Point(), Point(1, 1, 1)}));
      const double bound  = 3 * std::sqrt(3.) * std::pow(0.5, levels) / 4;
      CutPoints result;
      rule.points(0, result);
      expect_points_in_the_cell(result, 8);
      EXPECT_NEAR(sum_of_weights(result), volume, 1e-12);
      EXPECT_NEAR(volume, M_PI / 6, bound * M_PI / 6);
      Point moment;
      for (unsigned int q = 0; q < result.points.size(); ++q)
        moment += result.weights[q] * result.points[q];
      for (unsigned int d = 0; d < 3; ++d)
        EXPECT_NEAR(moment[d], M_PI / 16, bound * M_PI / 6);
    }
  }

  /// From a sliver of which the octree sees one layer of points to a cell that lacks a corner.
  TEST(MomentFitting, HasTheVolumeOfFiniteCellHoweverTheCellIsCut)
  {
    const Box cell({Point(), Point(1, 1, 1)});
    CutPoints result;
    for (unsigned int degree = 1; degree <= 2; ++degree)
      for (const double radius : {0.51, 0.515, 0.55, 0.8, 1.1, 1.3, 1.355, 1.363})
      {
        const Ball ball(radius, Point(0.5, 0.5, -0.5));
        MomentFitting rule({3}, degree, ball);
        FiniteCell finite({3}, degree, ball);
        const double volume = rule.add(cell);
        EXPECT_DOUBLE_EQ(volume, finite.add(cell));
        rule.points(0, result);
        expect_points_in_the_cell(result, std::pow(degree + 1, 3));
        EXPECT_NEAR(sum_of_weights(result), volume, 1e-9 * volume) << radius;
        EXPECT_EQ(result.points.empty(), volume == 0);
      }
  }

  TEST(MomentFitting, FitsEachMaterialByItself)
  {
    const Brick two(Box({Point(0, 0, 0), Point(4, 1, 1)}), 1.25);
    MomentFitting rule({2}, 1, two);
    const Box first({Point(-1, 0, 0), Point(1, 1, 1)}), second({Point(1, 0, 0), Point(2, 2, 1)});
    EXPECT_NEAR(rule.add(first), 1, 1e-14);
    EXPECT_NEAR(rule.add(second), 1, 1e-14);
    CutPoints result;
    rule.points(0, result);
    EXPECT_EQ(result.labels, std::vector<unsigned char>{0});
    EXPECT_NEAR(sum_of_weights(result), 1, 1e-10);

    rule.points(1, result);
    expect_points_in_the_cell(result, 16);
    ASSERT_EQ(result.labels.size(), result.points.size());
    std::array<double, 2> volume = {{0, 0}};
    for (unsigned int q = 0; q < result.points.size(); ++q)
    {
      EXPECT_EQ(result.labels[q], second.unit_to_real(result.points[q])[0] > 1.25);
      volume[result.labels[q]] += result.weights[q];
    }
    EXPECT_NEAR(volume[0], 0.25, 1e-10);
    EXPECT_NEAR(volume[1], 0.75, 1e-10);
  }

  /// Each of eight points has 1/80 of the volume at least, so that one alone in the second corner
  /// weighs six times too much. With all of them nearer and the right mean, the integral of xy
  /// misses at least half of what the second corner gives.
  TEST(MomentFitting, CountsTheCellsThatKeepThePointsOfFiniteCell)
  {
    const Box cell({Point(), Point(1, 1, 1)});
    const OppositeCorners corners;
    MomentFitting rule({7}, 1, corners);
    FiniteCell finite({7}, 1, corners);
    rule.add(Box({Point(-1, -1, -1), Point(0.05, 0.05, 0.05)}));
    EXPECT_EQ(rule.n_failures(), 0u);
    rule.add(cell);
    finite.add(cell);
    EXPECT_EQ(rule.n_failures(), 1u);
    CutPoints kept, all;
    rule.points(1, kept);
    finite.points(0, all);
    EXPECT_EQ(kept.points, all.points);
    EXPECT_EQ(kept.weights, all.weights);
  }
} // namespace softcell
