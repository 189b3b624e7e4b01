// SPDX-License-Identifier: LGPL-2.1-or-later
// Analytic bodies with their known sizes.
#pragma once

#include <softcell/geometry/shapes.h>

#include <cmath>
#include <memory>
#include <vector>

namespace softcell::testing
{
  struct ShapeCase
  {
    const char *name;
    std::shared_ptr<Body> body;
    double volume; // from a table of formulas
    double area;
    bool flat; // its triangles are the boundary itself
  };

  inline std::vector<ShapeCase> shapes()
  {
    const double pi = std::acos(-1.);
    return {{"box", make_box(Point(0.1, 0.2, 0.3)), 0.006, 0.22, true},
            {"cylinder", make_cylinder(0.05, 0.6), pi * 0.0015, 2 * pi * (0.03 + 0.0025), false},
            {"prism", make_hexagonal_prism(0.2, 0.1), 0.006 * std::sqrt(3.),
             0.12 + 0.12 * std::sqrt(3.), true},
            {"sphere", make_sphere(2), 32 * pi / 3, 16 * pi, false},
            {"hollow sphere", make_hollow_sphere(0.2, 0.1), 0.028 * pi / 3, 0.2 * pi, false},
            {"torus", make_torus(0.1, 0.05), 5e-4 * pi * pi, 0.02 * pi * pi, false}};
  }
} // namespace softcell::testing
