// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole simulations: equilibrium, and what they refuse.

#include "small_problems.h"

#include "../box_surface.h"

#include <softcell/base/exceptions.h>
#include <softcell/geometry/surface_body.h>

#include <cmath>

using namespace softcell;

TEST(Simulation, supports_bear_the_loads)
{
  for (const Method &method :
       {Method{"weighted cell", 1}, {"finite cell", 1}, {"finite cell", 2}, {"tetrahedra", 1}})
    for (const std::string imposition : {"strong", "Nitsche"})
    {
      SCOPED_TRACE(std::string(method.name) + ' ' + imposition);
      Parameters p                = body_of("cylinder", method, 4);
      p.material.density          = 10;
      p.discretization.cut.levels = 1;
      p.loads.gravity             = Direction({0, 0, -9.81});
      p.loads.imposition          = imposition;
      p.regions                   = {{"base", "z < 1e-9"}, {"top", "z > 1 - 1e-9"}};
      p.load_entries              = {{"base", "clamp"}, {"top", "traction 3, -5, 0"}};
      const ResultsRow row        = solve(p).row;
      const Direction applied     = vector_in(row, "top_f") + vector_in(row, "gravity_f");
      EXPECT_NEAR(row.number("gravity_fz"), -98.1 * row.number("volume"), 1e-9);
      // Chords of a quarter cut off (0.25 / r)^2 / 6 of the disc, those of the body's own surface
      // less than 1e-3.
      const double lost = std::string(method.name) == "tetrahedra" ? 0.25 / 6 : 1e-3;
      EXPECT_NEAR(row.number("top_fy"), -5 * M_PI / 4, 5 * M_PI / 4 * lost);
      EXPECT_LT((vector_in(row, "base_f") + applied).norm(), 1e-8 * applied.norm());
    }
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

TEST(Simulation, tells_the_edge_of_its_cells)
{
  Parameters p                  = body_of("box", {"weighted cell", 1}, 2);
  p.regions                     = {{"floor", "z < 1e-9"}};
  p.load_entries                = {{"floor", "clamp"}};
  p.discretization.grid.scale   = 1.2;
  p.discretization.grid.padding = 0.1; // 1.2 m + 0.2 m in two cells, which are halved at the skin
  EXPECT_NEAR(solve(p).row.number("cell_size"), 0.7, 1e-12);
  p.discretization.grid.surface_refinement = 1;
  EXPECT_NEAR(solve(p).row.number("cell_size"), 0.7, 1e-12);
  p.discretization.method    = "tetrahedra";
  p.discretization.mesh.size = 0.4;
  EXPECT_NEAR(solve(p).row.number("cell_size"), 0.4, 1e-12);
}

/// Two cubes in opposite corners of the only cell, one of them 1/512 of the other: there moment
/// fitting finds no few points (moment_fitting_test.cc).
TEST(Simulation, tells_of_cells_without_fitted_points)
{
  const Surface unit                       = box_surface(Point(1, 1, 1), 1);
  std::vector<Point> vertices              = unit.vertices();
  std::vector<Surface::Triangle> triangles = unit.triangles();
  for (Point &X : vertices)
    X /= 16;
  for (const Point &X : unit.vertices())
    vertices.push_back(Point(1, 1, 1) * 127. / 128 + (X - Point()) / 128);
  for (const auto &[a, b, c] : unit.triangles())
    triangles.push_back({a + 8, b + 8, c + 8});

  Parameters p                = body_of("surface", {"moment fitting", 1}, 1);
  p.discretization.cut.levels = 7;
  p.regions                   = {{"base", "z < 0.5"}};
  p.load_entries              = {{"base", "clamp"}};
  const Solved solved = solve(p, std::make_unique<SurfaceBody>(Surface(vertices, triangles)));
  EXPECT_EQ(solved.row.get("unfitted_cells"), "1");
  EXPECT_NE(solved.simulation->remarks().front().find("In 1 of 1 cut cells"), std::string::npos);

  p                           = body_of("cylinder", {"moment fitting", 1}, 3);
  p.discretization.cut.levels = 1;
  p.regions                   = {{"base", "z < 1e-9"}};
  p.load_entries              = {{"base", "clamp"}};
  EXPECT_EQ(solve(p).row.get("unfitted_cells"), "0");
}
