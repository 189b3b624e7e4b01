// SPDX-License-Identifier: LGPL-2.1-or-later
// What the analytic bodies share: a surface made when first asked for, and areas cut out of a disk.
#pragma once

#include <softcell/geometry/body.h>
#include <softcell/geometry/surface.h>

#include <map>
#include <mutex>
#include <optional>

namespace softcell
{
  /// Lengths that differ by less than this, relative to the body's size, count as equal: a box that
  /// is flush with the boundary is not cut by it.
  constexpr double flush = 1e-12;

  /// A body that makes the triangles of its boundary when it is first asked for them.
  class Shape : public Body
  {
  public:
    const Surface &surface() const final;

  private:
    virtual Surface make_surface() const = 0;

    mutable std::once_flag once_;
    mutable std::optional<Surface> surface_;
  };

  /// Collects triangles; corners at the very same place, to the last bit, become one vertex.
  class TriangleList
  {
  public:
    /// The corners turn anticlockwise seen from outside.
    void add(const Point &a, const Point &b, const Point &c, unsigned int patch);

    /// The quadrilateral as two triangles; anticlockwise seen from outside.
    void add(const Point &a, const Point &b, const Point &c, const Point &d, unsigned int patch);

    Surface finish();

  private:
    unsigned int vertex(const Point &X);

    std::map<std::array<double, 3>, unsigned int> numbers_;
    std::vector<Point> vertices_;
    std::vector<Surface::Triangle> triangles_;
    std::vector<unsigned int> patches_;
  };

  /// The points of a disk-like piece: ring 0 is its centre, ring k has k times as many points as
  /// ring 1.
  using Rings = std::vector<std::vector<Point>>;

  /// @param point  point(k, j) is point j of ring k > 0.
  template <class RingPoint>
  Rings make_rings(const Point &centre,
                   const unsigned int n_corners,
                   const unsigned int n_rings,
                   const RingPoint &point)
  {
    Rings rings = {{centre}};
    for (unsigned int k = 1; k <= n_rings; ++k)
    {
      rings.emplace_back();
      for (unsigned int j = 0; j < n_corners * k; ++j)
        rings.back().push_back(point(k, j));
    }
    return rings;
  }

  /// Adds the piece between the rings. `anticlockwise`: that is how the points turn seen from
  /// outside.
  void add_rings(TriangleList &list, const Rings &rings, bool anticlockwise, unsigned int patch);

  /// Smallest and largest distance of the box's points from the z axis.
  std::pair<double, double> distances_from_axis(const Box &box);

  /// Area of the part of the disk x^2 + y^2 <= radius^2 that lies in the box's x and y ranges.
  double disk_area_in(double radius, const Box &box);

  /// Length of the part of the box's range of coordinate d that lies in [low, high].
  double overlap(const Box &box, unsigned int d, double low, double high);
} // namespace softcell
