// SPDX-License-Identifier: LGPL-2.1-or-later
// What the analytic bodies share: a surface made when first asked for, and areas cut out of a disk.

#include <softcell/geometry/shape.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  const Surface &Shape::surface() const
  {
    std::call_once(once_, [&] { surface_.emplace(make_surface()); });
    return *surface_;
  }

  unsigned int TriangleList::vertex(const Point &X)
  {
    const auto [it, is_new] = numbers_.try_emplace({{X[0], X[1], X[2]}}, vertices_.size());
    if (is_new)
      vertices_.push_back(X);
    return it->second;
  }

  void TriangleList::add(const Point &a, const Point &b, const Point &c, const unsigned int patch)
  {
    triangles_.push_back({{vertex(a), vertex(b), vertex(c)}});
    patches_.push_back(patch);
  }

  void TriangleList::add(const Point &a,
                         const Point &b,
                         const Point &c,
                         const Point &d,
                         const unsigned int patch)
  {
    add(a, b, c, patch);
    add(a, c, d, patch);
  }

  Surface TriangleList::finish()
  {
    return Surface(std::move(vertices_), std::move(triangles_), std::move(patches_));
  }

  void add_rings(TriangleList &list,
                 const Rings &rings,
                 const bool anticlockwise,
                 const unsigned int patch)
  {
    const auto add = [&](const Point &a, const Point &b, const Point &c) {
      anticlockwise ? list.add(a, b, c, patch) : list.add(a, c, b, patch);
    };
    for (unsigned int k = 1; k < rings.size(); ++k)
    {
      const auto &inner = rings[k - 1], &outer = rings[k];
      for (unsigned int j = 0; j < outer.size(); ++j)
      {
        const unsigned int i = j / k * (k - 1) + j % k; // same sector, same place from its start
        const Point &a = inner[i % inner.size()], &next = outer[(j + 1) % outer.size()];
        add(a, outer[j], next);
        if (j % k + 1 < k)
          add(a, next, inner[(i + 1) % inner.size()]);
      }
    }
  }

  std::pair<double, double> distances_from_axis(const Box &box)
  {
    const auto &[low, high] = box.get_boundary_points();
    return {std::hypot(std::max({low[0], -high[0], 0.}), std::max({low[1], -high[1], 0.})),
            std::hypot(std::max(-low[0], high[0]), std::max(-low[1], high[1]))};
  }

  double overlap(const Box &box, const unsigned int d, const double low, const double high)
  {
    const auto &[from, to] = box.get_boundary_points();
    return std::max(0., std::min(to[d], high) - std::max(from[d], low));
  }

  namespace
  {
    /// Half the height of the disk at x; 0 beside the disk.
    double half_chord(const double radius, const double x)
    {
      return std::abs(x) < radius ? std::sqrt((radius - x) * (radius + x)) : 0.;
    }

    /// Integral of half_chord from a to b: the trapezoid below the chord and the circle's segment
    /// above it, which loses no digits where b is near a.
    double area_below_arc(const double radius, const double a, const double b)
    {
      const double height_a = half_chord(radius, a), height_b = half_chord(radius, b);
      const double angle =
        std::atan2(b * height_a - a * height_b, a * b + height_a * height_b); // of the arc
      const double q = angle * angle;
      const double angle_minus_sine =
        angle > 0.3 ? angle - std::sin(angle)
                    : angle * q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72 * (1 - q / 110))));
      return 0.5 * (b - a) * (height_a + height_b) + 0.5 * radius * radius * angle_minus_sine;
    }
  } // namespace

  double disk_area_in(const double radius, const Box &box)
  {
    const auto &[low, high] = box.get_boundary_points();
    const double left = std::max(low[0], -radius), right = std::min(high[0], radius);
    if (left >= right)
      return 0;

    // Between these x the region's upper and lower ends are each either the circle or the box.
    const double x0 = half_chord(radius, low[1]), x1 = half_chord(radius, high[1]);
    std::array<double, 6> ends = {{left, -x0, x0, -x1, x1, right}};
    for (double &x : ends)
      x = std::clamp(x, left, right);
    std::sort(ends.begin(), ends.end());

    double area = 0;
    for (unsigned int i = 0; i + 1 < ends.size(); ++i)
    {
      const double a = ends[i], b = ends[i + 1];
      const double height = half_chord(radius, 0.5 * (a + b));
      if (a == b || low[1] >= height || high[1] <= -height)
        continue;
      const bool arc_above = high[1] > height, arc_below = low[1] < -height;
      const double arc = arc_above || arc_below ? area_below_arc(radius, a, b) : 0;
      area += (arc_above ? arc : high[1] * (b - a)) - (arc_below ? -arc : low[1] * (b - a));
    }
    return area;
  }
} // namespace softcell
