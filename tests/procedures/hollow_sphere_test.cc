// SPDX-License-Identifier: LGPL-2.1-or-later
// A thick sphere whose wall is blown up, against its ordinary differential equation.

#include "small_problems.h"

#include <array>
#include <cmath>

namespace softcell
{
  namespace
  {
    /// The radially symmetric equilibrium r(R) of a Neo-Hookean hollow sphere: d P_rr / dR + 2
    /// (P_rr
    /// - P_tt) / R = 0, with r given inside and P_rr = 0 outside, by shooting.
    class Inflation
    {
    public:
      Inflation(const double inner,
                const double outer,
                const double mu,
                const double lambda,
                const double r_inner)
          : inner_(inner), outer_(outer), mu_(mu), lambda_(lambda), r_inner_(r_inner)
      {
        double low = 0.05, high = 2; // radial stretch inside; it raises the stress outside
        while (high - low > 1e-14)
        {
          const double middle                            = (low + high) / 2;
          const auto [r, stretch]                        = march(middle);
          (stress(stretch, r / outer_) < 0 ? low : high) = middle;
        }
        r_outer  = march(low)[0];
        pressure = -stress(low, r_inner_ / inner_) / std::pow(r_inner_ / inner_, 2);
      }

      double r_outer;  // at the end. Units: m
      double pressure; // inside, on the deformed wall. Units: Pa

    private:
      /// P_rr of the stretches along and across the radius; the law in principal stretches.
      double stress(const double along, const double across) const
      {
        return mu_ * (along - 1 / along) + lambda_ * std::log(along * across * across) / along;
      }

      /// Derivatives of r and of the radial stretch at R.
      std::array<double, 2> derivative(const double R, const std::array<double, 2> &y) const
      {
        const double across = y[0] / R, along = y[1], ln_J = std::log(along * across * across),
                     hoop = mu_ * (across - 1 / across) + lambda_ * ln_J / across,
                     d_along =
                       mu_ * (1 + 1 / (along * along)) + lambda_ * (1 - ln_J) / (along * along),
                     d_across = 2 * lambda_ / (along * across);
        return {{along, -(2 * (stress(along, across) - hoop) + d_across * (along - across)) /
                          (R * d_along)}};
      }

      /// r and the radial stretch outside, by Runge and Kutta's method.
      std::array<double, 2> march(const double stretch) const
      {
        constexpr unsigned int n = 400;
        const double h           = (outer_ - inner_) / n;
        std::array<double, 2> y  = {{r_inner_, stretch}};
        const auto ahead         = [&](const std::array<double, 2> &k, const double step) {
          return std::array<double, 2>{{y[0] + step * k[0], y[1] + step * k[1]}};
        };
        for (unsigned int i = 0; i < n; ++i)
        {
          const double R = inner_ + i * h;
          const auto k1 = derivative(R, y), k2 = derivative(R + h / 2, ahead(k1, h / 2)),
                     k3 = derivative(R + h / 2, ahead(k2, h / 2)),
                     k4 = derivative(R + h, ahead(k3, h));
          for (unsigned int c = 0; c < 2; ++c)
            y[c] += h / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);
        }
        return y;
      }

      const double inner_, outer_, mu_, lambda_, r_inner_;
    };
  } // namespace

  /// The shell of small strains has Lame's solution: u = A r + B / r^2. What it leaves out is of
  /// the order of the strain u / a.
  TEST(HollowSphere, TheEquationHasLamesLimit)
  {
    const double mu = 1, lambda = 1.5, a = 0.5, b = 1, u = 1e-6;
    const Inflation inflation(a, b, mu, lambda, a + u);
    // 3 K A = 4 mu B / b^3, u(a) = A a + B / a^2, p = 4 mu B / a^3 - 3 K A
    const double A_by_B = 4 * mu / ((3 * lambda + 2 * mu) * b * b * b),
                 B      = u / (A_by_B * a + 1 / (a * a));
    EXPECT_NEAR((inflation.r_outer - b) / (A_by_B * B * b + B / (b * b)), 1, 10 * u / a);
    EXPECT_NEAR(inflation.pressure / (4 * mu * B * (1 / (a * a * a) - 1 / (b * b * b))), 1,
                10 * u / a);
  }

  /// Springs that are too soft to matter keep the sphere where it is. Over the innermost cell, of
  /// edge h = 1/3, quadratic interpolation of B / r^2 errs by up to h^3 |f'''| / (72 sqrt(3)) with
  /// f''' = -24 B / r^5, which is 5.7 % of B / r^2 at r = 1/2; the
  /// bound is half of that, since interpolation errs in both directions within the cell and
  /// equilibrium takes a mean of it. In accord with the power of h, the errors are half as large
  /// with cells of 1/4 and one more level.
  TEST(HollowSphere, InflatesAsItsEquationSays)
  {
    Parameters p                = body_of("hollow sphere", {"finite cell", 2}, 6);
    p.geometry.radius           = 1;
    p.geometry.inner_radius     = 0.5;
    p.discretization.cut.levels = 2;
    p.load_steps.steps          = "adaptive";
    p.newton.residual_tolerance = p.newton.update_tolerance = 1e-8;
    const double mu = 1000 / 2.6, lambda = 1000 * 0.3 / (1.3 * 0.4);
    const Inflation exact(0.5, 1, mu, lambda, 0.6);
    const std::string radius = "x^2 + y^2 + (z - 1)^2";
    p.regions                = {{"inside", radius + " < 0.5"}, {"outside", radius + " > 0.5"}};
    p.load_entries           = {{"inside", "pressure " + std::to_string(exact.pressure)},
                                {"outside", "springs 1e-3"}};
    p.probes                 = {{"wall", "0.5, 0, 1"}, {"side", "1, 0, 1"}, {"top", "0, 0, 2"}};
    const ResultsRow row     = solve(p).row;
    if (is_root())
    {
      constexpr double bound = 0.057 / 2;
      EXPECT_NEAR(row.number("wall_ux"), 0.1, bound * 0.1);
      EXPECT_NEAR(row.number("side_ux"), exact.r_outer - 1, bound * (exact.r_outer - 1));
      EXPECT_NEAR(row.number("top_uz"), exact.r_outer - 1, bound * (exact.r_outer - 1));
    }
  }
} // namespace softcell
