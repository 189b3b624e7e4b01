// SPDX-License-Identifier: LGPL-2.1-or-later
// The error of one displacement against another.

#include "../box_of_cells.h"

#include <softcell/studies/difference.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    Direction reference(const Point &X)
    {
      return Direction({X[0], 0, 0});
    }

    const std::vector<Material> linear = {Material("linear", 5, 0.25)}; // lambda = mu = 2 Pa
  }                                                                     // namespace

  // u_ref = (x, 0, 0) and u - u_ref = (0, 0, e x y) on the unit cube:
  // |u_ref|^2 = 1/3, |u - u_ref|^2 = e^2/9, |grad u_ref|^2 = 1, |grad (u - u_ref)|^2 = 2 e^2/3;
  // the stresses are diag(6, 2, 2) Pa and 2 e (sigma_xz = y, sigma_yz = x) Pa, hence
  // |sigma_ref|^2 = 44, |sigma - sigma_ref|^2 = 8 e^2 (1/3 + 1/3).
  TEST(Difference, HasTheNormsOfKnownFields)
  {
    const double e = 0.01;
    const BoxOfCells coarse({2, 1, 4}, Point(1, 1, 1), MPI_COMM_WORLD),
      fine({3, 4, 5}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Vector u_fine = nodal_values(fine, reference);
    const Vector u      = nodal_values(coarse, [&](const Point &X) {
      return reference(X) + Direction({0, 0, e * X[0] * X[1]});
    });
    const Difference d  = difference(coarse, u, fine, u_fine, linear, 0);
    EXPECT_NEAR(d.relative_l2, e / std::sqrt(3.), 1e-12);
    EXPECT_NEAR(d.relative_h1, e * std::sqrt(2. / 3), 1e-12);
    EXPECT_NEAR(d.relative_stress, e * std::sqrt(16. / 3 / 44), 1e-12);
    EXPECT_EQ(d.missed, 0);
  }

  // F = diag(-1, 1, 1) has no stress, so that the error is the whole stress of the reference.
  TEST(Difference, CountsPointsTurnedInsideOutAsFreeOfStress)
  {
    const BoxOfCells cells({1, 1, 1}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Vector u_ref = nodal_values(cells, reference);
    const Vector u     = nodal_values(cells, [](const Point &X) { return -2 * reference(X); });
    EXPECT_NEAR(
      difference(cells, u, cells, u_ref, {Material("Neo-Hookean", 5, 0.25)}, 0).relative_stress, 1,
      1e-14);
  }

  TEST(Difference, LeavesOutWhatIsBeyondReach)
  {
    const BoxOfCells half({1, 1, 3}, Point(1, 1, 0.5), MPI_COMM_WORLD),
      whole({1, 1, 4}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Vector u_whole = nodal_values(whole, reference), u = nodal_values(half, reference);
    const Difference d = difference(half, u, whole, u_whole, linear, 0);
    EXPECT_NEAR(d.missed, 0.5, 1e-14);
    EXPECT_LT(d.relative_l2, 1e-14);
    EXPECT_EQ(difference(half, u, whole, u_whole, linear, 1).missed, 0);
  }
} // namespace softcell
