// SPDX-License-Identifier: LGPL-2.1-or-later
// Resultants and moments of weight and traction.

#include "../box_of_cells.h"

#include <softcell/loads/dead_loads.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    /// Minus the virtual work of a load: r . v for the nodal values v of a field.
    template <class Field>
    double work(const Discretization &body, const Load &load, const double t, const Field &field)
    {
      Vector r = body.make_vector(), u = nodal_values(body, field);
      load.add_residual(u, t, r);
      r.compress(dealii::VectorOperation::add);
      return -(r * u);
    }
  } // namespace

  TEST(Weight, IsMassTimesGravity)
  {
    const BoxOfCells body({2, 3, 4}, Point(0.1, 0.2, 0.3), MPI_COMM_WORLD);
    const Direction g({0, 1, -9.81});
    const Weight weight(body, g, {1060.});
    EXPECT_EQ(weight.region(), "gravity");
    const Vector u    = nodal_values(body, [](const Point &X) { return Direction({0, 0, X[2]}); });
    const double mass = 1060 * 0.1 * 0.2 * 0.3;
    EXPECT_LT((weight.total_force(u, 0.5) - 0.5 * mass * g).norm(), 1e-12 * mass);
    EXPECT_NEAR(weight.energy(u, 1), 9.81 * mass * 0.15, 1e-12 * mass); // u_z = z, mean 0.15
    const auto about_x = [](const Point &X) { return Direction({0, -X[2], X[1]}); };
    EXPECT_NEAR(work(body, weight, 1, about_x), mass * (-0.15 - 9.81 * 0.1), 1e-12 * mass);
  }

  TEST(Traction, HasTheResultantAndMomentOfItsField)
  {
    const BoxOfCells body({2, 3, 4}, Point(1, 1, 1), MPI_COMM_WORLD);
    const Region top("top", "nz > 0.5");
    const Traction uniform(body, body.surface_patches(top), Expression("1, -30, 2", 3, ""), "top");
    const Vector u = body.make_vector();
    EXPECT_LT((uniform.total_force(u, 1) - Direction({1, -30, 2})).norm(), 1e-12);
    EXPECT_EQ(uniform.region(), "top");

    // Traction (0, 0, x) t^2 on z = 1: force 1/2, moment about y of -int x x dA = -1/3.
    const Traction linear(body, body.surface_patches(top), Expression("0, 0, x*t^2", 3, ""), "top");
    EXPECT_NEAR(linear.total_force(u, 3)[2], 9 * 0.5, 1e-12);
    EXPECT_NEAR(linear.total_force(u, 0.5)[2], 0.25 * 0.5, 1e-12); // integrated anew
    const auto about_y = [](const Point &X) { return Direction({X[2], 0, -X[0]}); };
    EXPECT_NEAR(work(body, linear, 1, about_y), -1. / 3, 1e-12);
  }
} // namespace softcell
