// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole simulations against patch tests, equilibrium and the balance of energy.

#include <softcell/base/exceptions.h>
#include <softcell/procedures/simulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace
{
  using namespace softcell;

  struct Method
  {
    const char *name;
    unsigned int degree;
  };

  Parameters body_of(const std::string &type, const Method &method, const unsigned int cells)
  {
    Parameters p;
    p.geometry.type             = type;
    p.geometry.size             = Point(1, 1, 1);
    p.geometry.radius           = 0.5;
    p.geometry.length           = 1;
    p.material.young_modulus    = 1000;
    p.material.poisson_ratio    = 0.3;
    p.discretization.method     = method.name;
    p.discretization.degree     = method.degree;
    p.discretization.grid.cells = {cells};
    p.linear_solver.solver      = "direct";
    p.newton.residual_tolerance = 1e-12;
    p.newton.update_tolerance   = 1e-12;
    return p;
  }

  struct Solved
  {
    std::unique_ptr<Body> body;
    std::unique_ptr<Simulation> simulation;
    ResultsRow row;
  };

  Solved solve(const Parameters &parameters)
  {
    std::ostringstream log;
    Console console(log, false, 1e9);
    std::vector<std::string> remarks;
    Solved solved;
    solved.body       = make_body(parameters.geometry, remarks);
    solved.simulation = std::make_unique<Simulation>("test", parameters, *solved.body, console);
    EXPECT_TRUE(solved.simulation->solve("")) << solved.simulation->reason();
    solved.row = solved.simulation->row();
    return solved;
  }

  Direction vector_in(const ResultsRow &row, const std::string &name)
  {
    return Direction({row.number(name + "x"), row.number(name + "y"), row.number(name + "z")});
  }

  /// Only rank 0 fills the columns of probes.
  bool is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /// Stretch across of a Neo-Hookean bar that is free at its sides and stretched by `along`: the
  /// root of its lateral stress mu (c - 1/c) + lambda ln(along c^2) / c, by bisection.
  double lateral_stretch(const double along, const double mu, const double lambda)
  {
    double low = 0.1, high = 2;
    while (high - low > 1e-15)
    {
      const double c                                                             = (low + high) / 2;
      (mu * (c - 1 / c) + lambda * std::log(along * c * c) / c < 0 ? low : high) = c;
    }
    return low;
  }

  const Method conforming[] = {{"hexahedra", 1},
                               {"hexahedra", 2},
                               {"tetrahedra", 1},
                               {"tetrahedra", 2}};
} // namespace

TEST(Simulation, conforming_methods_pass_the_patch_test_of_displacements)
{
  for (const Method &method : conforming)
  {
    SCOPED_TRACE(std::string(method.name) + std::to_string(method.degree));
    Parameters p        = body_of("box", method, 3);
    p.regions           = {{"skin", "1"}};
    p.load_entries      = {{"skin", "displacement 0.1*x+0.2*y, -0.05*x+0.1*z, 0.15*z-0.1*y"}};
    p.probes            = {{"a", "0.43, 0.51, 0.62"}};
    const Solved solved = solve(p);
    if (is_root())
    {
      const Direction expected({0.043 + 0.102, -0.0215 + 0.062, 0.093 - 0.051});
      EXPECT_LT((vector_in(solved.row, "a_u") - expected).norm(), 1e-10);
    }
  }
}

TEST(Simulation, conforming_methods_pass_the_patch_test_of_tractions)
{
  const double E = 1000, nu = 0.3, along = 1.2;
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const double across  = lateral_stretch(along, mu, lambda);
  const double J       = along * across * across;
  const double tension = mu * (along - 1 / along) + lambda * std::log(J) / along;
  for (const Method &method : conforming)
  {
    SCOPED_TRACE(std::string(method.name) + std::to_string(method.degree));
    Parameters p = body_of("box", method, 3);
    p.regions    = {{"left", "x < 1e-9"},
                    {"right", "x > 1 - 1e-9"},
                    {"front", "y < 1e-9"},
                    {"floor", "z < 1e-9"}};
    std::ostringstream traction;
    traction.precision(17);
    traction << "traction " << tension << ", 0, 0";
    p.load_entries      = {{"left", "displacement 0, free, free"},
                           {"front", "displacement free, 0, free"},
                           {"floor", "displacement free, free, 0"},
                           {"right", traction.str()}};
    p.probes            = {{"a", "0.7, 0.4, 0.9"}};
    const Solved solved = solve(p);
    if (is_root())
    {
      const Direction expected({0.7 * (along - 1), 0.4 * (across - 1), 0.9 * (across - 1)});
      EXPECT_LT((vector_in(solved.row, "a_u") - expected).norm(), 1e-10);
    }
    EXPECT_NEAR(solved.row.number("min_jacobian"), J, 1e-9);
    EXPECT_NEAR(solved.row.number("left_fx"), -tension, 1e-7 * tension);
  }
}

/// A ball that is imposed a linear displacement through Nitsche's method: the error is that of the
/// cut quadrature.
TEST(Simulation, finite_cell_passes_the_patch_test_as_its_levels_grow)
{
  const auto error = [](const std::string &method, const unsigned int levels) {
    Parameters p                = body_of("sphere", {method.c_str(), 1}, 4);
    p.discretization.cut.levels = levels;
    p.material.model            = "linear";
    p.regions                   = {{"skin", "1"}};
    p.load_entries              = {{"skin", "displacement 0.1*x+0.2*y, -0.05*x, 0.15*z"}};
    p.loads.imposition          = "Nitsche";
    p.probes                    = {{"a", "0.1, -0.2, 0.6"}};
    const Solved solved         = solve(p);
    return (vector_in(solved.row, "a_u") - Direction({-0.03, -0.005, 0.09})).norm() / 0.1;
  };
  const double coarse = error("finite cell", 1), fine = error("finite cell", 4);
  const double weighted = error("weighted cell", 4);
  if (is_root())
  {
    EXPECT_LT(fine, coarse / 4);
    EXPECT_LT(fine, 1e-3);
    RecordProperty("weighted_cell_defect", std::to_string(weighted));
    EXPECT_LT(weighted, 0.05);
  }
}

TEST(Simulation, supports_bear_the_loads)
{
  for (const Method &method :
       {Method{"weighted cell", 1}, {"finite cell", 1}, {"finite cell", 2}, {"tetrahedra", 1}})
    for (const std::string imposition : {"strong", "Nitsche"})
    {
      SCOPED_TRACE(std::string(method.name) + ' ' + imposition);
      Parameters p            = body_of("cylinder", method, 4);
      p.material.density      = 10;
      p.loads.gravity         = Direction({0, 0, -9.81});
      p.loads.imposition      = imposition;
      p.regions               = {{"base", "z < 1e-9"}, {"top", "z > 1 - 1e-9"}};
      p.load_entries          = {{"base", "clamp"}, {"top", "traction 3, -5, 0"}};
      const ResultsRow row    = solve(p).row;
      const Direction applied = vector_in(row, "top_f") + vector_in(row, "gravity_f");
      EXPECT_NEAR(row.number("gravity_fz"), -98.1 * row.number("volume"), 1e-9);
      // chords of a quarter cut off (0.25 / r)^2 / 6 of the disc
      const double lost = std::string(method.name) == "tetrahedra" ? 0.25 / 6 : 1e-3;
      EXPECT_NEAR(row.number("top_fy"), -5 * M_PI / 4, 5 * M_PI / 4 * lost);
      EXPECT_LT((vector_in(row, "base_f") + applied).norm(), 1e-8 * applied.norm());
    }
}

/// Clapeyron: the energy of a linear body is half the work of its loads.
TEST(Simulation, strain_energy_is_the_work_of_the_loads)
{
  Parameters p         = body_of("cylinder", {"weighted cell", 1}, 4);
  p.material.model     = "linear";
  p.regions            = {{"base", "z < 1e-9"}, {"top", "z > 1 - 1e-9"}};
  p.load_entries       = {{"base", "clamp"}, {"top", "displacement 0, 0, 0.2"}};
  const ResultsRow row = solve(p).row;
  EXPECT_NEAR(row.number("strain_energy"), row.number("top_fz") * 0.2 / 2, 1e-9);

  p.load_entries         = {{"base", "clamp"}, {"top", "traction 0, 0, 30"}};
  const ResultsRow force = solve(p).row;
  EXPECT_GT(force.number("strain_energy"), 0.1);
  EXPECT_NEAR(force.number("strain_energy"), -force.number("load_energy") / 2, 1e-9);

  p.load_entries.push_back({"top", "pressure 1"}); // which has no potential
  EXPECT_EQ(solve(p).row.get("load_energy"), "");
}

TEST(Simulation, free_body_is_refused)
{
  Parameters p   = body_of("box", {"weighted cell", 1}, 3);
  p.regions      = {{"top", "z > 1 - 1e-9"}};
  p.load_entries = {{"top", "traction 0, 0, 1"}};
  EXPECT_THROW(solve(p), BadInput);
}

TEST(Simulation, material_of_unknown_label_is_refused)
{
  Parameters p            = body_of("box", {"weighted cell", 1}, 3);
  p.label_materials["17"] = p.material;
  p.regions               = {{"floor", "z < 1e-9"}};
  p.load_entries          = {{"floor", "clamp"}};
  EXPECT_THROW(solve(p), BadInput);
}
