// SPDX-License-Identifier: LGPL-2.1-or-later
// Known displacements, their derivatives, and the forces that go with them.

#include "../box_of_cells.h"

#include <softcell/loads/manufactured_solution.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    const Point places[] = {Point(0.2, 0.7, 0.4), Point(-0.3, 0.1, 0.9), Point(1.1, 0.45, -0.2)};

    Point shifted(Point X, const unsigned int axis, const double h)
    {
      X[axis] += h;
      return X;
    }

    double hooke(const char *what)
    {
      const double E = 1000, nu = 0.3;
      return what == std::string("mu") ? E / (2 * (1 + nu)) : E * nu / ((1 + nu) * (1 - 2 * nu));
    }
  } // namespace

  TEST(ManufacturedSolution, HasTheGradientOfItsDisplacement)
  {
    for (const std::string &name : manufactured_solution_names())
    {
      const ManufacturedSolution exact(name, 0.3);
      const double h = 1e-5;
      for (const Point &X : places)
        for (unsigned int d = 0; d < dim; ++d)
        {
          const Direction difference =
            (exact.displacement(shifted(X, d, h)) - exact.displacement(shifted(X, d, -h))) /
            (2 * h);
          for (unsigned int c = 0; c < dim; ++c)
            EXPECT_NEAR(exact.gradient(X)[c][d], difference[c], 1e-8);
        }
    }
  }

  /// The traction on a plane normal to e_d is column d of P, which differences derive.
  TEST(ManufacturedSolution, HasTheBodyForceThatBalancesItsStress)
  {
    for (const char *model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
      for (const std::string &name : manufactured_solution_names())
      {
        const Material material(model, 1000, 0.3);
        const ManufacturedSolution exact(name, 0.08);
        const double h = 1e-5, t = 0.7;
        for (const Point &X : places)
        {
          Direction divergence;
          for (unsigned int d = 0; d < dim; ++d)
          {
            Direction e;
            e[d] = 1;
            divergence += (exact.traction(material, shifted(X, d, h), e, t) -
                           exact.traction(material, shifted(X, d, -h), e, t)) /
                          (2 * h);
          }
          EXPECT_LT((exact.body_force(material, X, t) + divergence).norm(), 1e-5)
            << model << ' ' << name;
        }
      }
  }

  /// For Hooke's law, f = -(lambda + mu) grad div u - mu laplace u, here by hand for the sine.
  TEST(ManufacturedSolution, HasTheBodyForceOfHookesLaw)
  {
    const Material material("linear", 1000, 0.3);
    const ManufacturedSolution exact("sine", 0.08);
    const double mu = hooke("mu"), lambda = hooke("lambda"), pi = M_PI;
    const Direction a({0.08, 0.04, -0.06});
    for (const Point &X : places)
    {
      const Direction s({std::sin(pi * X[0]), std::sin(pi * X[1]), std::sin(pi * X[2])}),
        c({std::cos(pi * X[0]), std::cos(pi * X[1]), std::cos(pi * X[2])});
      for (unsigned int i = 0; i < dim; ++i)
      {
        const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
        const double grad_div =
          pi * pi *
          (-a[i] * s[i] * s[j] * s[k] + a[j] * c[i] * c[j] * s[k] + a[k] * c[i] * s[j] * c[k]);
        const double laplace = -3 * pi * pi * a[i] * s[0] * s[1] * s[2];
        EXPECT_NEAR(exact.body_force(material, X, 1)[i], -(lambda + mu) * grad_div - mu * laplace,
                    1e-10 * mu);
        EXPECT_NEAR(exact.displacement(X)[i], a[i] * s[0] * s[1] * s[2], 1e-15);
      }
    }
  }

  /// The loads do the work of their densities: at the virtual displacement e_x, the resultant.
  TEST(ManufacturedSolution, ItsLoadsBalanceEachOther)
  {
    // Two Gauss points along an edge err by O(h^4).
    double unbalanced[2];
    for (const unsigned int n : {4, 8})
    {
      const BoxOfCells body({n, n, n}, Point(0.5, 0.5, 0.5), MPI_COMM_WORLD);
      const Material material("Neo-Hookean", 1000, 0.3);
      const ManufacturedSolution exact("waves", 0.05);
      const ManufacturedBodyForce force(body, exact, material);
      const ManufacturedTraction traction(body, body.surface_patches(Region("all", "1")), exact,
                                          material, "all");
      const Vector u = body.make_vector();
      EXPECT_EQ(traction.region(), "all");
      EXPECT_GT(force.total_force(u, 1).norm(), 10);
      unbalanced[n / 8] = (force.total_force(u, 1) + traction.total_force(u, 1)).norm();
    }
    EXPECT_LT(unbalanced[1], unbalanced[0] / 12);
  }
} // namespace softcell
