// SPDX-License-Identifier: LGPL-2.1-or-later
// The order of each method, by a solution that is known.

#include "../box_surface.h"
#include "../procedures/small_problems.h"

#include <softcell/geometry/surface_body.h>
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

    Difference error(const Parameters &parameters, std::unique_ptr<Body> body)
    {
      const Solved solved = solve(parameters, std::move(body));
      const auto points =
        finer_points(parameters.discretization, parameters.geometry, *solved.body, MPI_COMM_WORLD);
      return difference(solved.simulation->discretization(), solved.simulation->displacement(),
                        *points, *solved.simulation->exact(), solved.simulation->materials(), 0.1);
    }

    Difference error(const Parameters &parameters)
    {
      std::vector<std::string> remarks;
      return error(parameters, make_body(parameters.geometry, remarks));
    }

    double order(const double coarse, const double fine, const double refinement)
    {
      return std::log(coarse / fine) / std::log(refinement);
    }

    struct ImmersedCase
    {
      const char *body, *model;
      Method method;
      unsigned int coarse, fine;
      double ghost_penalty;
    };

    /// Drawn on one half of the boundary and held by Nitsche's method on the other. Theory: p + 1
    /// in L2 and p in H1. A lost term costs half an order at least; at so few cells, how the body
    /// lies in the grid moves the order by less.
    void expect_orders(const ImmersedCase &one)
    {
      SCOPED_TRACE(std::string(one.model) + ' ' + one.method.name + ' ' +
                   std::to_string(one.method.degree));
      const auto error_of = [&](const unsigned int n) {
        Parameters p                       = body_of(one.body, one.method, n);
        p.material.model                   = one.model;
        p.discretization.cut.levels        = 3;
        p.discretization.cut.ghost_penalty = one.ghost_penalty;
        p.loads.manufactured               = "waves";
        p.loads.imposition                 = "Nitsche";
        p.regions      = {{"held", "nx + ny + nz > 0"}, {"loaded", "nx + ny + nz <= 0"}};
        p.load_entries = {{"held", "displacement exact"}, {"loaded", "traction exact"}};
        if (p.geometry.type == "surface")
          return error(p, std::make_unique<SurfaceBody>(turned_box_surface(Point(1, 1, 1))));
        return error(p);
      };
      const Difference at_coarse = error_of(one.coarse), at_fine = error_of(one.fine);
      const double refinement = double(one.fine) / one.coarse;
      EXPECT_GT(order(at_coarse.relative_l2, at_fine.relative_l2, refinement),
                one.method.degree + 0.85);
      EXPECT_GT(order(at_coarse.relative_h1, at_fine.relative_h1, refinement),
                one.method.degree - 0.2);
    }
  } // namespace

  /// Theory: p + 1 in L2, p in H1 and of the stress.
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
        EXPECT_NEAR(order(at_coarse.relative_stress, at_fine.relative_stress, refinement),
                    method.degree, 0.1);
      }
  }

  /// The cube lies across the grid. Weighted cells have the orders of finite cells too while they
  /// are so large that the error of their rule hides.
  TEST(Manufactured, ImmersedMethodsHaveTheirOrdersOnACube)
  {
    for (const ImmersedCase &one :
         {ImmersedCase{"surface", "Saint-Venant-Kirchhoff", {"finite cell", 1}, 6, 12, 0.01},
          {"surface", "Neo-Hookean", {"finite cell", 1}, 6, 12, 0.01},
          {"surface", "Neo-Hookean", {"finite cell", 2}, 3, 6, 0.01},
          {"surface", "Saint-Venant-Kirchhoff", {"weighted cell", 1}, 6, 12, 0.01}})
      expect_orders(one);
  }

  /// The grid cuts its outer cells in halves, which one level resolves exactly: where cut cells are
  /// integrated with an error, that hides degree 3. Theory: 4 in L2 and 3 in H1, against
  /// 1 / h = n - 1. A quarter of an order is left to the outer cells, whose errors are smaller and
  /// which are fewer on the finer grid; a lost term costs half an order at least.
  TEST(Manufactured, FiniteCellsOfDegreeThreeHaveTheirOrdersWhereTheirRuleIsExact)
  {
#ifndef NDEBUG
    GTEST_SKIP() << "takes minutes without optimisation";
#endif
    const auto error_of = [](const unsigned int n) {
      Parameters p                = unit_cube("Neo-Hookean", {"finite cell", 3}, n);
      p.discretization.cut.levels = 1;
      p.discretization.grid.scale = n / (n - 1.);
      p.loads.imposition          = "Nitsche";
      return error(p);
    };
    const Difference at_coarse = error_of(3), at_fine = error_of(5);
    EXPECT_GT(order(at_coarse.relative_l2, at_fine.relative_l2, 2), 3.75);
    EXPECT_GT(order(at_coarse.relative_h1, at_fine.relative_h1, 2), 2.75);
  }

  TEST(Manufactured, ImmersedMethodsHaveTheirOrdersOnABall)
  {
#ifndef NDEBUG
    GTEST_SKIP() << "takes minutes without optimisation";
#endif
    for (const ImmersedCase &one :
         {ImmersedCase{"sphere", "Saint-Venant-Kirchhoff", {"finite cell", 1}, 6, 12, 0.1},
          {"sphere", "Saint-Venant-Kirchhoff", {"finite cell", 2}, 3, 4, 0.01}})
      expect_orders(one);
  }
} // namespace softcell
