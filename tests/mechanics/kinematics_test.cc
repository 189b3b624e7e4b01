// SPDX-License-Identifier: LGPL-2.1-or-later
// Strains and the matrix algebra under them against hand-made values.

#include <softcell/mechanics/kinematics.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using softcell::Matrix3;

  const Matrix3<double> sheared{{1, 0.5, 0, 0, 1, 0, 0, 0, 1}};
  const Matrix3<double> general{{2, -1, 0.5, 0, 3, 1, 4, 1, -2}};

  TEST(Kinematics, SimpleShear)
  {
    const Matrix3<double> E = softcell::green_lagrange_strain(sheared);
    const Matrix3<double> e = softcell::small_strain(sheared);
    EXPECT_DOUBLE_EQ(E(0, 1), 0.25);
    EXPECT_DOUBLE_EQ(E(1, 0), 0.25);
    EXPECT_DOUBLE_EQ(E(1, 1), 0.125);
    EXPECT_DOUBLE_EQ(E(0, 0), 0);
    EXPECT_DOUBLE_EQ(e(0, 1), 0.25);
    EXPECT_DOUBLE_EQ(e(1, 1), 0);
    EXPECT_DOUBLE_EQ(softcell::volume_change(sheared), 0);
    EXPECT_DOUBLE_EQ(softcell::right_cauchy_green(sheared)(1, 1), 1.25);
  }

  TEST(Kinematics, DeterminantInverseAndVolumeChange)
  {
    // By expansion along the first column: 2 (3 (-2) - 1) + 4 (-1 - 1.5).
    EXPECT_DOUBLE_EQ(softcell::determinant(general), -24);
    EXPECT_DOUBLE_EQ(softcell::volume_change(general), -25);
    const Matrix3<double> one = general * softcell::inverse(general);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(one(i, j), i == j, 1e-15);
  }

  TEST(Kinematics, TinyVolumeChangesKeepTheirDigits)
  {
    const double h = std::ldexp(1, -40);
    const Matrix3<double> F{{1 + h, 0, 0, 0, 1 + h, 0, 0, 0, 1 + h}};
    EXPECT_DOUBLE_EQ(softcell::volume_change(F), 3 * h + 3 * h * h);
  }

  TEST(Kinematics, PressureOnAStretchedCube)
  {
    // A force of 6 N on a face of 1 m^2 at rest, which became 2 m x 3 m.
    const Matrix3<double> F{{5, 0, 0, 0, 2, 0, 0, 0, 3}}, P{{6, 0, 0, 0, 0, 0, 0, 0, 0}};
    EXPECT_DOUBLE_EQ(softcell::cauchy_stress(P, F)(0, 0), 1);
  }
} // namespace
