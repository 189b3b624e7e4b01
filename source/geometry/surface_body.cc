// SPDX-License-Identifier: LGPL-2.1-or-later
// The body enclosed by a closed triangle surface: exact classification and exact volumes of boxes.

#include <softcell/geometry/surface_body.h>

#include <algorithm>

namespace softcell
{
  namespace
  {
    /// Integral of height(z) over the projection of a polygon to z = 0, positive where its normal
    /// points up; `height` is linear.
    template <class Height>
    double integrate_projection(const std::vector<Point> &polygon, const Height &height)
    {
      double integral = 0;
      for (unsigned int i = 2; i < polygon.size(); ++i)
      {
        const Direction a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double area = (a[0] * b[1] - a[1] * b[0]) / 2;
        integral += area * height((polygon[0][2] + polygon[i - 1][2] + polygon[i][2]) / 3);
      }
      return integral;
    }
  } // namespace

  SurfaceBody::SurfaceBody(Surface surface)
      : surface_(std::move(surface)),
        bounding_box_(surface_.bounding_box()),
        volume_(surface_.volume())
  {
    Assert(volume_ > 0, dealii::ExcMessage("The surface's normals point inward."));
  }

  Box SurfaceBody::bounding_box() const
  {
    return bounding_box_;
  }

  bool SurfaceBody::contains(const Point &X) const
  {
    return surface_.contains(X);
  }

  Side SurfaceBody::classify(const Box &box) const
  {
    auto [lower, upper]       = box.get_boundary_points();
    const Direction clearance = 1e-9 * (upper - lower);
    if (surface_.meets(Box({lower + clearance, upper - clearance})))
      return Side::cut;
    return surface_.contains(box.center()) ? Side::inside : Side::outside;
  }

  double SurfaceBody::filled_volume(const Box &box) const
  {
    if (!surface_.meets(box))
      return surface_.contains(box.center()) ? box.volume() : 0;

    const auto [lower, upper] = box.get_boundary_points();
    const double ceiling      = upper[2];
    const double height       = upper[2] - lower[2];
    const Box column(
      {lower, Point(upper[0], upper[1], std::max(ceiling, bounding_box_.upper_bound(2)))});

    double volume = 0;
    for (const unsigned int triangle : surface_.triangles_in(column))
    {
      const auto corners = surface_.corners(triangle);
      volume +=
        integrate_projection(clip(corners, column), [&](double) { return height; }) -
        integrate_projection(clip(corners, box), [&](const double z) { return ceiling - z; });
    }
    return std::clamp(volume, 0., box.volume());
  }

  double SurfaceBody::volume() const
  {
    return volume_;
  }

  const Surface &SurfaceBody::surface() const
  {
    return surface_;
  }
} // namespace softcell
