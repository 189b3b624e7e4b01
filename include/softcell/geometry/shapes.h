// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies given by a formula: box, cylinder, sphere, hollow sphere, torus and hexagonal prism.
#pragma once

#include <softcell/geometry/body.h>

#include <memory>

namespace softcell
{
  // Sizes are positive and in m. The bodies stand on z = 0 with their axis along z, the box with a
  // corner at the origin. Box classification is exact, and a box flush with the boundary counts as
  // inside or outside, not as cut. The vertices of surface() lie on the true boundary; its area and
  // volume fall short of the true ones by less than 1e-3 (relative), those of the box and the
  // hexagonal prism not at all; on_boundary() makes up for that.

  /// [0, size]. Patches as deal.II numbers them: 0 and 1 at the lower and upper x, 2 and 3 y, 4 and
  /// 5 z.
  std::unique_ptr<Body> make_box(const Point &size);

  /// x^2 + y^2 <= radius^2, 0 <= z <= length. Patches: 0 side, 1 base, 2 top.
  std::unique_ptr<Body> make_cylinder(double radius, double length);

  /// A regular hexagon times 0 <= z <= length; `radius` goes from the axis to its corners, one of
  /// which lies on the x axis. Patches: 0 side, 1 base, 2 top.
  std::unique_ptr<Body> make_hexagonal_prism(double radius, double length);

  /// The ball around (0, 0, radius). One patch. The filled volume of a box is good to 1e-9 of the
  /// box's volume.
  std::unique_ptr<Body> make_sphere(double radius);

  /// That ball less the ball of `inner_radius` (< radius) about its centre. Patches: 0 outside,
  /// 1 inside.
  std::unique_ptr<Body> make_hollow_sphere(double radius, double inner_radius);

  /// The points within `tube_radius` of the circle of `ring_radius` (> tube_radius) about the z
  /// axis at z = tube_radius. One patch. The filled volume of a box is good to 1e-9 of the box's
  /// volume.
  std::unique_ptr<Body> make_torus(double ring_radius, double tube_radius);
} // namespace softcell
