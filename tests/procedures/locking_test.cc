// SPDX-License-Identifier: LGPL-2.1-or-later
// A nearly incompressible beam, with and without projection of the volumetric strain.

#include "small_problems.h"

namespace softcell
{
  namespace
  {
    /// Deflection of a clamped linear beam by a force across its end, in parts of Timoshenko's,
    /// F L^3 / (3 E I) + F L / (G A 5/6). Rank 0 alone has it.
    double relative_deflection(const Method &method, const unsigned int n, const bool projection)
    {
      const double L = 10, E = 1000, nu = 0.499, force = 1e-3, I = 1. / 12, G = E / (2 * (1 + nu));
      Parameters p                = body_of("box", method, n);
      p.geometry.size             = Point(1, 1, L);
      p.material.model            = "linear";
      p.material.poisson_ratio    = nu;
      p.discretization.projection = projection;
      p.discretization.grid.scale = 1.1; // for background grids, so that cells are cut
      p.regions                   = {{"base", "z < 1e-6"}, {"end", "z > 10 - 1e-6"}};
      p.load_entries              = {{"base", "clamp"}, {"end", "traction 0, 1e-3, 0"}};
      p.probes                    = {{"end", "0.5, 0.5, 10"}};
      const double exact          = force * (L * L * L / (3 * E * I) + L / (G * 5 / 6));
      return solve(p).row.number("end_uy") / exact;
    }
  } // namespace

  // In a beam of height H, trilinear cells of edge h are too stiff in shear by (G/E) (h/H)^2, here
  // by a twelfth; the clamp, which lets nothing contract, stiffens the beam by some percent more.
  TEST(Locking, projection_frees_a_nearly_incompressible_beam)
  {
    for (const char *const method : {"hexahedra", "finite cell", "weighted cell"})
    {
      SCOPED_TRACE(method);
      const double locked = relative_deflection({method, 1}, 2, false);
      const double freed  = relative_deflection({method, 1}, 2, true);
      if (is_root())
      {
        EXPECT_LT(locked, 0.55);
        EXPECT_GT(freed, 1.4 * locked); // cut cells of this size err by more than locking
        EXPECT_LT(freed, 1);
        if (std::string(method) == "hexahedra")
        {
          EXPECT_GT(freed, 1 - 1. / 12 - 0.04);
        }
      }
    }
    const double quadratic = relative_deflection({"hexahedra", 2}, 2, true);
    const double fitted    = relative_deflection({"tetrahedra", 2}, 3, false);
    if (is_root())
    {
      EXPECT_NEAR(quadratic, fitted, 0.02);
    }
  }
} // namespace softcell
