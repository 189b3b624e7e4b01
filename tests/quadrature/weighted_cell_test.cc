// SPDX-License-Identifier: LGPL-2.1-or-later
// The weighted cell rule against finite cell's volumes and exact weights.

#include <softcell/quadrature/finite_cell.h>
#include <softcell/quadrature/weighted_cell.h>

#include <gtest/gtest.h>

#include <numeric>

#include "simple_bodies.h"

namespace softcell
{
  namespace
  {
    const Box unit_cell({Point(), Point(1, 1, 1)});
    const Ball corner_ball(0.8, Point(0.1, 0.2, 0.3));

    double total(const CutPoints &points)
    {
      return std::accumulate(points.weights.begin(), points.weights.end(), 0.);
    }
  } // namespace

  TEST(WeightedCell, HasTheVolumeOfFiniteCell)
  {
    CutPoints result;
    for (unsigned int levels = 1; levels <= 4; ++levels)
    {
      WeightedCell weighted({levels, 0}, 1, corner_ball);
      FiniteCell finite({levels, 0}, 1, corner_ball);
      const double volume = weighted.add(unit_cell);
      EXPECT_NEAR(volume, finite.add(unit_cell), 1e-13);
      weighted.points(0, result);
      ASSERT_EQ(result.weights.size(), 8u);
      EXPECT_NEAR(total(result), volume, 1e-13);
      for (const double w : result.weights)
        EXPECT_GE(w, 0);
    }
  }

  TEST(WeightedCell, WeighsEachOctantByWhatIsFilled)
  {
    // the lower half along z, and of that a quarter of the upper x
    const Brick brick(Box({Point(-1, -1, -1), Point(0.625, 2, 0.5)}));
    WeightedCell rule({3, 0}, 1, brick);
    EXPECT_NEAR(rule.add(unit_cell), 0.625 * 0.5, 1e-14);
    CutPoints result;
    rule.points(0, result);
    for (unsigned int i = 0; i < 8; ++i)
      EXPECT_NEAR(result.weights[i], i >= 4 ? 0 : (i % 2 ? 0.25 : 1) / 8., 1e-14) << i;
  }

  TEST(WeightedCell, PartsOfHigherDegreesFillTheCell)
  {
    for (unsigned int degree = 2; degree <= 3; ++degree)
    {
      WeightedCell rule({5, 0}, degree, corner_ball);
      FiniteCell fine({6, 0}, 1, corner_ball);
      EXPECT_NEAR(rule.add(unit_cell), fine.add(unit_cell), 1e-3);
      CutPoints result;
      rule.points(0, result);
      EXPECT_EQ(result.weights.size(), std::pow(degree + 1, 3));
      // all of the body, and a cell full but for a billionth
      const Brick all(Box({Point(-1, -1, -1), Point(2, 2, 2)}));
      WeightedCell full({2, 0}, degree, all);
      EXPECT_NEAR(full.add(unit_cell), 1, 1e-13);
    }
  }

  TEST(WeightedCell, TakesTheLabelOfMostOfThePart)
  {
    // of the upper octants' parts [0.5, 1], 3/10 are material 0, and all that is filled
    const Brick two(Box({Point(-1, -1, -1), Point(0.75, 2, 2)}), 0.65);
    WeightedCell rule({4, 0}, 1, two);
    rule.add(unit_cell);
    CutPoints result;
    rule.points(0, result);
    ASSERT_EQ(result.labels.size(), 1u); // 0.15 of 0, 0.1 of 1
    EXPECT_EQ(result.labels[0], 0);

    const Brick other(Box({Point(-1, -1, -1), Point(0.75, 2, 2)}), 0.55);
    WeightedCell other_rule({4, 0}, 1, other);
    other_rule.add(unit_cell);
    other_rule.points(0, result);
    ASSERT_EQ(result.labels.size(), 8u);
    for (unsigned int i = 0; i < 8; ++i)
      EXPECT_EQ(result.labels[i], i % 2);
  }

  // Bodies that fill the cell up to a corner, and whether fewer than four octants hold more than a
  // tenth of what the fullest one holds.
  TEST(WeightedCell, SpreadsTheVolumeOfAMechanismAlone)
  {
    const auto weights = [](const Point &upper, const double spread) {
      const Brick brick(Box({Point(-1, -1, -1), upper}));
      WeightedCell rule({5, 0, spread}, 1, brick);
      EXPECT_NEAR(rule.add(unit_cell), upper[0] * upper[1] * upper[2], 1e-14);
      CutPoints result;
      rule.points(0, result);
      EXPECT_NEAR(total(result), upper[0] * upper[1] * upper[2], 1e-14);
      return result.weights;
    };
    const std::vector<std::pair<Point, bool>> cases = {{Point(0.25, 0.5, 0.375), true},  // one
                                                       {Point(0.75, 0.5, 0.5), true},    // two
                                                       {Point(1, 17. / 32, 0.5), true},  // 1, 1/16
                                                       {Point(1, 18. / 32, 0.5), false}, // 1, 1/8
                                                       {Point(1, 0.75, 0.125), false}};
    for (const auto &[upper, is_mechanism] : cases)
    {
      const auto brunet = weights(upper, 0);
      for (unsigned int i = 0; i < 8; ++i)
      {
        const Point octant(i % 2, i / 2 % 2, i / 4);
        double expected = 1;
        for (unsigned int d = 0; d < 3; ++d)
          expected *= std::clamp(upper[d] - octant[d] / 2, 0., 0.5);
        EXPECT_NEAR(brunet[i], expected, 1e-14) << upper;
      }
      for (const double spread : {CutParameters().spread, 0.4})
        for (unsigned int i = 0; i < 8; ++i)
          EXPECT_NEAR(weights(upper, spread)[i],
                      is_mechanism
                        ? (1 - spread) * brunet[i] + spread * upper[0] * upper[1] * upper[2] / 8
                        : brunet[i],
                      1e-14)
            << upper;
    }
  }
} // namespace softcell
