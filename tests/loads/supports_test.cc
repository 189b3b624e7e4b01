// SPDX-License-Identifier: LGPL-2.1-or-later
// Springs and penalty.

#include "tangent_check.h"

#include <softcell/loads/supports.h>

#include <gtest/gtest.h>

namespace softcell
{
  TEST(Penalty, PullsByStiffnessTimesMisfit)
  {
    const BoxOfCells body({2, 2, 3}, Point(2, 1, 1), MPI_COMM_WORLD);
    const Region bottom("bottom", "nz < -0.5");
    const Penalty penalty(body, body.surface_patches(bottom), Expression("0.1, free, 0", 3, ""),
                          Expression("1000*x", 1, ""), "bottom");
    const Vector u = nodal_values(body, [](const Point &) { return Direction({0.3, 5, 0.2}); });
    // int 1000 x dA = 2000; at t = 1/2 the misfit is (0.25, -, 0.2).
    EXPECT_LT((penalty.total_force(u, 0.5) - Direction({-500, 0, -400})).norm(), 1e-9);
    EXPECT_NEAR(penalty.energy(u, 0.5), 0.5 * 2000 * (0.0625 + 0.04), 1e-9);
    const Vector v = some_direction(body);
    EXPECT_LT(energy_error(body, penalty, some_displacement(body), v, 0.5), 1e-8);
    EXPECT_LT(tangent_error(body, penalty, u, v, 0.5), 1e-8);
  }
} // namespace softcell
