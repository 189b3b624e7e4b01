// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's method on a body whose load follows its surface.

#include "small_problems.h"

#include <softcell/discretization/methods.h>
#include <softcell/procedures/model.h>

#include <cmath>

using namespace softcell;

// The pressed face's rim is free: without the skew part of the tangent the iteration is linear at
// best.
TEST(Follower, pressure_with_a_free_rim_converges_quadratically)
{
  for (const std::string solver : {"direct", "CG"})
  {
    SCOPED_TRACE(solver);
    Parameters p              = body_of("box", {"hexahedra", 1}, 3);
    p.geometry.size           = Point(0.1, 0.1, 0.2);
    p.material.young_modulus  = 5000;
    p.linear_solver.solver    = solver;
    p.linear_solver.tolerance = 1e-10;

    std::vector<Region> regions; // which cannot be copied
    regions.emplace_back("base", "z < 1e-9");
    regions.emplace_back("top", "z > 0.2 - 1e-9");
    const auto descriptions = parse_loads({{"base", "clamp"}, {"top", "pressure -500"}}, regions);
    const std::vector<Material> materials{
      Material(p.material.model, p.material.young_modulus, p.material.poisson_ratio)};
    std::vector<std::string> remarks;
    const auto body = make_body(p.geometry, remarks);
    const auto bar =
      make_discretization(p.discretization, p.geometry, *body, MPI_COMM_WORLD, remarks);
    const Loads loads =
      make_loads(p.loads, descriptions, regions, *bar, body->surface(), materials);
    Timers timers;
    Model model(*bar, materials, false, loads, p.linear_solver, timers);
    model.set_load(1);

    Vector u = bar->make_vector();
    std::vector<double> residuals;
    const NewtonResult result =
      newton_raphson(model.equations(), p.newton, u,
                     [&](const NewtonIteration &i) { residuals.push_back(i.residual); });
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.iterations, 6u);
    // An order of 1.5 at least, down to round-off.
    for (unsigned int i = 1; i < residuals.size(); ++i)
      if (residuals[i - 1] < 1e-2)
      {
        EXPECT_LE(residuals[i], std::max(std::pow(residuals[i - 1], 1.5), 1e-13));
      }
  }
}
