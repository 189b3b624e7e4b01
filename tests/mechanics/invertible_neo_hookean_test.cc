// SPDX-License-Identifier: LGPL-2.1-or-later
// The continued Neo-Hookean law: the law itself above J_0, smooth below and never without a way
// back.

#include <softcell/mechanics/laws.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  constexpr double young = 5000, poisson = 0.45;
  const auto continued = make_law<InvertibleNeoHookean>(young, poisson);
  const double J_0     = continued.smallest_regular<double>();

  // flat, inside out along one axis, along all, and barely continued
  const std::vector<Matrix3<double>> deep = {{{1, 0.2, 0, 0.1, 1.1, 0.3, 0, 0, 0}},
                                             {{1.1, 0.1, 0.2, -0.1, 0.9, 0.1, 0.2, 0, -0.8}},
                                             {{-0.9, 0.1, 0, 0.2, -1.1, 0, 0.1, 0.3, -0.5}},
                                             {{0.6, 0.05, 0, 0, 0.7, 0.1, 0.05, 0, 0.45}}};
  const Matrix3<double> change{{0.3, -0.5, 0.2, 0.7, 0.1, -0.4, -0.6, 0.25, 0.9}};

  TEST(InvertibleNeoHookean, IsNeoHookeanAboveTheThreshold)
  {
    const auto regular = make_law<NeoHookean>(young, poisson);
    const Matrix3<double> F{{1.2, 0.3, -0.1, -0.2, 0.9, 0.25, 0.15, -0.05, 0.4}};
    ASSERT_GT(determinant(F), J_0);
    EXPECT_NEAR(continued.energy(F), regular.energy(F), 1e-14 * young);
    const auto P = continued.first_piola_stress(F), P_regular = regular.first_piola_stress(F);
    const auto dP         = continued.linearisation(F)(change),
               dP_regular = regular.linearisation(F)(change);
    for (int k = 0; k < 9; ++k)
    {
      EXPECT_NEAR(P.entries[k], P_regular.entries[k], 1e-12 * young);
      EXPECT_NEAR(dP.entries[k], dP_regular.entries[k], 1e-12 * young);
    }
  }

  // Central differences err by h^2 times third derivatives of some hundred E.
  TEST(InvertibleNeoHookean, StressAndTangentAreDerivativesWhereItIsContinued)
  {
    const double h = 1e-5;
    for (const Matrix3<double> &F : deep)
    {
      ASSERT_LT(determinant(F), J_0);
      const Matrix3<double> up = F + h * change, down = F - h * change;
      EXPECT_NEAR(double_contraction(continued.first_piola_stress(F), change),
                  (continued.energy(up) - continued.energy(down)) / (2 * h), 1e-6 * young);
      const auto difference =
        1 / (2 * h) * (continued.first_piola_stress(up) - continued.first_piola_stress(down));
      const auto tangent = continued.linearisation(F);
      const auto dP      = tangent(change);
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(dP.entries[k], difference.entries[k], 1e-6 * young);
      for (int b = 0; b < 3; ++b)
      {
        Matrix3<double> row{};
        for (int A = 0; A < 3; ++A)
          row(b, A) = change(b, A);
        const auto by_row =
          tangent(NodalGradient<double>{b, {change(b, 0), change(b, 1), change(b, 2)}}) -
          tangent(row);
        for (const double entry : by_row.entries)
          EXPECT_NEAR(entry, 0, 1e-12 * young);
      }
    }
  }

  // Two continuous derivatives: on both sides of J_0 the same energy, stress and tangent.
  TEST(InvertibleNeoHookean, IsSmoothAtTheThreshold)
  {
    const double step = 1e-9;
    Matrix3<double> below{{0.5, 0, 0, 0, 0.8, 0, 0, 0, J_0 / 0.4 * (1 - step)}}, above = below;
    above(2, 2) = J_0 / 0.4 * (1 + step);
    EXPECT_NEAR(continued.energy(below), continued.energy(above), 100 * step * young);
    const auto P_below  = continued.first_piola_stress(below),
               P_above  = continued.first_piola_stress(above);
    const auto dP_below = continued.linearisation(below)(change),
               dP_above = continued.linearisation(above)(change);
    for (int k = 0; k < 9; ++k)
    {
      EXPECT_NEAR(P_below.entries[k], P_above.entries[k], 1e4 * step * young);
      EXPECT_NEAR(dP_below.entries[k], dP_above.entries[k], 1e4 * step * young);
    }
  }

  // A bar that is pushed through itself: from any place its energy falls towards its length at
  // rest, so no state but that is one of rest.
  TEST(InvertibleNeoHookean, PushesBackFromEveryLength)
  {
    for (double length = -3; length < 3; length += 0.05)
    {
      Matrix3<double> F = identity<double>();
      F(2, 2)           = length;
      const double pull = continued.first_piola_stress(F)(2, 2);
      EXPECT_TRUE(std::abs(length - 1) < 0.01 || pull * (length - 1) > 0) << length;
    }
  }
} // namespace
