// SPDX-License-Identifier: LGPL-2.1-or-later
// A part of a surface inside another one, of a material of its own.

#include "../box_surface.h"

#include "small_problems.h"

#include <softcell/geometry/surface_body.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  /// The unit cube with a cube of half its size in the middle, which is patch 7.
  std::unique_ptr<Body> nested_cubes()
  {
    const Surface outer                      = box_surface(Point(1, 1, 1), 1);
    std::vector<Point> vertices              = outer.vertices();
    std::vector<Surface::Triangle> triangles = outer.triangles();
    std::vector<unsigned int> patches(triangles.size(), 0);
    const unsigned int n = vertices.size();
    for (const Point &X : outer.vertices())
      vertices.push_back(Point(0.25, 0.25, 0.25) + 0.5 * (X - Point()));
    for (const auto &[a, b, c] : outer.triangles())
      triangles.push_back({a + n, b + n, c + n});
    patches.resize(triangles.size(), 7);
    return std::make_unique<SurfaceBody>(Surface(vertices, triangles, patches),
                                         std::vector<unsigned int>{7}, "");
  }
} // namespace

/// Three cells across have planes at 1/3 and 2/3: with L levels the finite cell sees the
/// inclusion's sides in steps of 2^-L / 3, half of which is the error of an edge's length of 1/2 at
/// either end.
TEST(Simulation, finite_cell_refines_towards_an_inclusion)
{
  for (const unsigned int levels : {2u, 4u})
  {
    Parameters p;
    p.geometry.type             = "surface";
    p.label_materials["7"]      = p.material;
    p.material.density          = 0;
    p.discretization.method     = "finite cell";
    p.discretization.cut.levels = levels;
    p.discretization.grid.cells = {3};
    p.linear_solver.solver      = "direct";
    p.loads.gravity             = Direction({0, 0, -1e-3});
    p.regions                   = {{"base", "z < 1e-9"}};
    p.load_entries              = {{"base", "clamp"}};
    const ResultsRow row        = solve(p, nested_cubes()).row;
    const double step           = std::pow(0.5, levels) / 3;
    EXPECT_NEAR(std::cbrt(-row.number("gravity_fz")), 0.5, step);
  }
}

/// The grid's planes are those of the cubes, so that volumes are exact but for tetrahedra.
TEST(Simulation, inclusion_has_the_weight_of_its_own_material)
{
  for (const std::string method : {"finite cell", "weighted cell", "tetrahedra"})
  {
    SCOPED_TRACE(method);
    Parameters p;
    p.geometry.type                = "surface";
    p.material.density             = 1;
    p.label_materials["7"]         = p.material;
    p.label_materials["7"].density = 9;
    p.discretization.method        = method;
    p.discretization.grid.cells    = {8};
    p.linear_solver.solver         = "direct";
    p.loads.gravity                = Direction({0, 0, -10});
    p.regions                      = {{"base", "z < 1e-9"}};
    p.load_entries                 = {{"base", "clamp"}};

    const ResultsRow row   = solve(p, nested_cubes()).row;
    const double weight    = -10 * (1. + 8. / 8); // 8 kg/m^3 more in an eighth of the volume
    const double tolerance = method == "tetrahedra" ? 0.05 : 1e-9;
    EXPECT_NEAR(row.number("gravity_fz"), weight, -tolerance * weight);
    EXPECT_NEAR(row.number("base_fz"), -weight, -tolerance * weight);
  }
}
