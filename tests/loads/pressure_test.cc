// SPDX-License-Identifier: LGPL-2.1-or-later
// Pressure on the deformed surface.

#include "tangent_check.h"

#include <softcell/loads/pressure.h>

#include <gtest/gtest.h>

namespace softcell
{
  TEST(Pressure, OfAClosedSurfaceHasNoResultant)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Region all("all", "1");
    const Pressure pressure(body, body.surface_patches(all), Expression("100", 1, ""), "all");
    EXPECT_LT(pressure.total_force(some_displacement(body), 1).norm(), 1e-11);
  }

  // The vector area of an open surface depends on its rim alone: the top of the cube, sheared,
  // stretched to (1.5, 2) and bulging inside its rim, keeps the area of the flat patch.
  TEST(Pressure, PushesOnTheDeformedArea)
  {
    const BoxOfCells body({4, 4, 2}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Region top("top", "nz > 0.5");
    const Pressure pressure(body, body.surface_patches(top), Expression("10", 1, ""), "top");
    const Vector u = nodal_values(body, [](const Point &X) {
      return Direction(
        {0.5 * X[0] + 0.2 * X[1] + 0.7 * X[2], X[1], X[0] * (1 - X[0]) * X[1] * (1 - X[1])});
    });
    EXPECT_LT((pressure.total_force(u, 0.5) - Direction({0, 0, -0.5 * 10 * 1.5 * 2})).norm(),
              1e-12);

    // A quarter turn about y takes the normal from z to x, and the force with it.
    const Vector turned = nodal_values(body, [](const Point &X) {
      return Direction({X[2] - X[0], 0, -X[0] - X[2]});
    });
    EXPECT_LT((pressure.total_force(turned, 1) - Direction({-10, 0, 0})).norm(), 1e-12);
  }

  TEST(Pressure, TangentIsTheDerivativeOnAnOpenSurfaceWithAFreeRim)
  {
    const BoxOfCells body({2, 3, 2}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Region top("top", "nz > 0.5");
    const Pressure pressure(body, body.surface_patches(top), Expression("100 + 50 * x", 1, ""),
                            "top");
    EXPECT_LT(tangent_error(body, pressure, some_displacement(body), some_direction(body), 0.7),
              1e-8);
  }

  // Bonet and Wood, sec. 8.5.
  TEST(Pressure, UniformOnAClosedSurfaceHasASymmetricTangent)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Region all("all", "1");
    const Pressure pressure(body, body.surface_patches(all), Expression("100", 1, ""), "all");
    const Vector u = some_displacement(body), v = some_direction(body);
    Vector Ku = body.make_vector(), Kv = body.make_vector();
    const BlockMatrix K = tangent_of(body, pressure, u, 0.7);
    K.vmult(Ku, u);
    K.vmult(Kv, v);
    EXPECT_NEAR(v * Ku, u * Kv, 1e-12 * v.l2_norm() * Ku.l2_norm());
  }
} // namespace softcell
