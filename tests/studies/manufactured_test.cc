// SPDX-License-Identifier: LGPL-2.1-or-later
// The order of each method, by a solution that is known.

#include "../procedures/small_problems.h"

#include <softcell/studies/difference.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    /// The unit cube with n cells along each edge, held at the exact displacement all around.
    Parameters unit_cube(const char *model, const Method &method, const unsigned int n)
    {
      Parameters p         = body_of("box", method, n);
      p.material.model     = model;
      p.loads.manufactured = "waves";
      p.regions            = {{"boundary", "1"}};
      p.load_entries       = {{"boundary", "displacement exact"}};
      return p;
    }

    Difference error(const Parameters &parameters)
    {
      const Solved solved = solve(parameters);
      const auto points =
        finer_points(parameters.discretization, parameters.geometry, *solved.body, MPI_COMM_WORLD);
      return difference(solved.simulation->discretization(), solved.simulation->displacement(),
                        *points, *solved.simulation->exact(), 0.1);
    }

    double order(const double coarse, const double fine, const double refinement)
    {
      return std::log(coarse / fine) / std::log(refinement);
    }
  } // namespace

  /// Theory: p + 1 in L2 and p in H1.
  TEST(Manufactured, ElementsOfDegreePHaveOrderPPlusOne)
  {
    struct Sizes
    {
      Method method;
      unsigned int coarse, fine;
    };
    for (const char *model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
      for (const auto &[method, coarse, fine] : {Sizes{{"hexahedra", 1}, 2, 4},
                                                 {{"hexahedra", 2}, 2, 4},
                                                 {{"tetrahedra", 1}, 4, 8},
                                                 {{"tetrahedra", 2}, 2, 4}})
      {
        SCOPED_TRACE(std::string(model) + ' ' + method.name + ' ' + std::to_string(method.degree));
        const Difference at_coarse = error(unit_cube(model, method, coarse)),
                         at_fine   = error(unit_cube(model, method, fine));
        const double refinement    = double(fine) / coarse;
        EXPECT_NEAR(order(at_coarse.relative_l2, at_fine.relative_l2, refinement),
                    method.degree + 1, 0.1);
        EXPECT_NEAR(order(at_coarse.relative_h1, at_fine.relative_h1, refinement), method.degree,
                    0.1);
      }
  }
} // namespace softcell
