// SPDX-License-Identifier: LGPL-2.1-or-later
// Problems of elasticity whose answers are in textbooks.

#include "small_problems.h"

#include <array>
#include <cmath>

namespace softcell
{
  namespace
  {
    constexpr double E = 1000; // of body_of()

    std::string text(const double value)
    {
      std::ostringstream stream;
      stream.precision(17);
      stream << value;
      return stream.str();
    }

    /// A beam of section 1 x 1 along z, clamped at its base, without lateral contraction, so that a
    /// clamp does not strain it. Cubic hexahedra, whose deflection is that of the theory.
    Parameters beam(const unsigned int length, const char *model)
    {
      Parameters p                = body_of("box", {"hexahedra", 3}, 1);
      p.geometry.size             = Point(1, 1, length);
      p.material.model            = model;
      p.material.poisson_ratio    = 0;
      p.discretization.grid.cells = {2, 2, (length + 1) / 2};
      p.regions = {{"base", "z < 1e-6"}, {"top", "z > " + text(length) + " - 1e-6"}};
      p.probes  = {{"tip", "0.5, 0.5, " + text(length)}};
      return p;
    }
  } // namespace

  /// Timoshenko: F l^3 / (3 E I) + F l / (kappa G A) with kappa = 5/6 of a rectangle; I = 1/12,
  /// A = 1, G = E/2. Euler and Bernoulli leave out the shear, which is 0.6/l^2 of the rest. The
  /// clamp hinders the section's warping near itself: less than a tenth of the shear of one depth.
  TEST(Classical, CantileversBendAsTimoshenkoAndEulerSay)
  {
    for (const unsigned int l : {3, 20})
    {
      Parameters p         = beam(l, "linear");
      p.load_entries       = {{"base", "clamp"}, {"top", "traction 1, 0, 0"}};
      const ResultsRow row = solve(p).row;
      if (!is_root())
        continue;
      const double euler = 4. * l * l * l / E, shear = 2.4 * l / E;
      EXPECT_NEAR((row.number("tip_ux") - euler) / shear, 1, 0.1 / l);
      if (l == 20)
      {
        EXPECT_NEAR(row.number("tip_ux") / euler, 1, 2e-3);
      }
    }
  }

  /// Bisshopp and Drucker's elastica: theta'' = -a cos theta, theta(0) = theta'(1) = 0, tip at the
  /// integral of sin theta. By shooting with Runge and Kutta's method. The beam also shears, by
  /// 0.6/l^2 of its small deflection.
  TEST(Classical, ASlenderBeamBendsFarAsTheElastica)
  {
    constexpr double a = 2; // F l^2 / (E I)
    const auto tip     = [&](const double curvature) {
      std::array<double, 3> y = {{0, curvature, 0}}; // angle, its derivative, deflection
      const auto derivative   = [&](const std::array<double, 3> &at) {
        return std::array<double, 3>{{at[1], -a * std::cos(at[0]), std::sin(at[0])}};
      };
      const auto ahead = [&](const std::array<double, 3> &k, const double h) {
        return std::array<double, 3>{{y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2]}};
      };
      constexpr unsigned int n = 1000;
      constexpr double h       = 1. / n;
      for (unsigned int i = 0; i < n; ++i)
      {
        const auto k1 = derivative(y), k2 = derivative(ahead(k1, h / 2)),
                   k3 = derivative(ahead(k2, h / 2)), k4 = derivative(ahead(k3, h));
        for (unsigned int c = 0; c < 3; ++c)
          y[c] += h / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);
      }
      return y;
    };
    double low = 0, high = 2 * a;
    while (high - low > 1e-13)
      (tip((low + high) / 2)[1] < 0 ? low : high) = (low + high) / 2;
    const double deflection = tip(low)[2];
    EXPECT_NEAR(deflection, 0.4935, 1e-4); // their table

    constexpr unsigned int l = 20;
    Parameters p             = beam(l, "Saint-Venant-Kirchhoff");
    p.load_entries           = {{"base", "clamp"},
                                {"top", "traction " + text(a * E / 12 / l / l) + ", 0, 0"}};
    const ResultsRow row     = solve(p).row;
    if (is_root())
    {
      EXPECT_NEAR(row.number("tip_ux") / l, deflection, 3e-3 * deflection);
    }
  }

  /// Saint-Venant's torsion, of which the energy is G J theta^2 / (2 l): J = pi r^4 / 2 of a circle
  /// and 0.140577 of a unit square, whose ends must be free to warp.
  TEST(Classical, BarsTwistAsSaintVenantSays)
  {
    constexpr double G = E / 2.6, theta = 0.01, l = 2;
    const auto energy = [&](Parameters p, const std::string &x, const std::string &y) {
      p.material.model      = "linear";
      p.loads.imposition    = "Nitsche";
      const std::string end = text(theta / 2);
      p.regions             = {{"base", "nz < -0.5"}, {"top", "nz > 0.5"}};
      p.load_entries        = {
               {"base",
                "displacement " + end + " * " + y + ", -" + end + " * " + x + ", free; springs 1e-6"},
               {"top", "displacement -" + end + " * " + y + ", " + end + " * " + x + ", free"}};
      return solve(p).row.number("strain_energy") * 2 * l / (G * theta * theta);
    };

    Parameters square                = body_of("box", {"hexahedra", 2}, 1);
    square.geometry.size             = Point(1, 1, l);
    square.discretization.grid.cells = {8, 8, 2};
    const double of_square           = energy(square, "(x - 0.5)", "(y - 0.5)");

    for (const char *name : {"hexahedra", "finite cell"})
    {
      Parameters circle                = body_of("cylinder", {name, 2}, 4);
      circle.geometry.length           = l;
      circle.discretization.cut.levels = 3;
      const double of_circle           = energy(circle, "x", "y");
      EXPECT_NEAR(of_circle, M_PI / 32, 4e-3 * M_PI / 32); // 1e-3 of the radius
    }
    EXPECT_NEAR(of_square, 0.140577, 2e-4 * 0.140577);
  }
} // namespace softcell
