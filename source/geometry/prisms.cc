// SPDX-License-Identifier: LGPL-2.1-or-later
// Box, cylinder and hexagonal prism: a plane section times a range of z.

#include <softcell/geometry/shape.h>
#include <softcell/geometry/shapes.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace softcell
{
  namespace
  {
    using dealii::numbers::PI;

    Side either(const bool inside, const bool outside)
    {
      return outside ? Side::outside : inside ? Side::inside : Side::cut;
    }

    Side both(const Side a, const Side b)
    {
      return either(a == Side::inside && b == Side::inside,
                    a == Side::outside || b == Side::outside);
    }

    /// How the box's range of coordinate d lies to [0, length].
    Side side_of_range(const Box &box, const unsigned int d, const double length)
    {
      const double low = box.lower_bound(d), high = box.upper_bound(d), tolerance = flush * length;
      return either(low >= -tolerance && high <= length + tolerance,
                    high <= tolerance || low >= length - tolerance);
    }

    bool in_range(const double x, const double length)
    {
      return x >= -flush * length && x <= (1 + flush) * length;
    }

    class BoxBody final : public Shape
    {
    public:
      explicit BoxBody(const Point &size) : size_(size) {}

      Box bounding_box() const override
      {
        return Box({Point(), size_});
      }

      bool contains(const Point &X) const override
      {
        return in_range(X[0], size_[0]) && in_range(X[1], size_[1]) && in_range(X[2], size_[2]);
      }

      Side classify(const Box &box) const override
      {
        return both(both(side_of_range(box, 0, size_[0]), side_of_range(box, 1, size_[1])),
                    side_of_range(box, 2, size_[2]));
      }

      double filled_volume(const Box &box) const override
      {
        return overlap(box, 0, 0, size_[0]) * overlap(box, 1, 0, size_[1]) *
               overlap(box, 2, 0, size_[2]);
      }

      double volume() const override
      {
        return size_[0] * size_[1] * size_[2];
      }

    private:
      /// Each face as 16 x 16 rectangles.
      Surface make_surface() const override
      {
        constexpr unsigned int n = 16;
        TriangleList list;
        for (unsigned int d = 0; d < dim; ++d)
          for (const bool upper : {false, true})
          {
            const unsigned int e = (d + 1) % dim, f = (d + 2) % dim;
            const auto point = [&](const unsigned int i, const unsigned int j) {
              Point X;
              X[d] = upper ? size_[d] : 0;
              X[e] = size_[e] * i / n;
              X[f] = size_[f] * j / n;
              return X;
            };
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                if (upper)
                  list.add(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1),
                           2 * d + 1);
                else
                  list.add(point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j),
                           2 * d);
          }
        return list.finish();
      }

      const Point size_;
    };

    /// x^2 + y^2 <= radius^2. Its 132 chords enclose 3.8e-4 less than the circle.
    struct Disk
    {
      static constexpr unsigned int n_rings = 22, n_chords = 6 * n_rings;

      explicit Disk(const double radius_) : radius(radius_) {}

      Point extent() const
      {
        return Point(radius, radius, 0);
      }

      bool contains(const Point &X) const
      {
        return std::hypot(X[0], X[1]) <= radius * (1 + flush);
      }

      Side classify(const Box &box) const
      {
        const auto [nearest, farthest] = distances_from_axis(box);
        return either(farthest <= radius * (1 + flush), nearest >= radius * (1 - flush));
      }

      double area_in(const Box &box) const
      {
        return disk_area_in(radius, box);
      }

      double area() const
      {
        return PI * radius * radius;
      }

      Rings rings() const
      {
        return make_rings(Point(), 6, n_rings, [&](const unsigned int k, const unsigned int j) {
          const double angle = PI * j / (3 * k);
          return Point(Point(std::cos(angle), std::sin(angle), 0) * (radius * k / n_rings));
        });
      }

      /// Points of the side go outward to the circle, those of the ends in proportion to their
      /// distance from the axis.
      BoundaryPoint on_boundary(const Point &X, const Direction &normal, const bool is_side) const
      {
        if (is_side)
        {
          const double r = std::hypot(X[0], X[1]);
          const Direction ray({X[0] / r, X[1] / r, 0});
          return {X + (radius - r) * ray, ray, radius / r * (normal * ray)};
        }
        const double half = PI / n_chords, angle = std::atan2(X[1], X[0]) + 2 * PI,
                     factor = std::cos(std::fmod(angle, 2 * half) - half) / std::cos(half);
        return {Point(factor * X[0], factor * X[1], X[2]), normal, factor * factor};
      }

      const double radius;
    };

    /// A regular hexagon about the origin.
    struct Hexagon
    {
      explicit Hexagon(const double radius_) : radius(radius_)
      {
        for (unsigned int i = 0; i < corners.size(); ++i)
          corners[i] = Point(std::cos(PI * i / 3), std::sin(PI * i / 3), 0) * radius;
      }

      Point extent() const
      {
        return Point(radius, inner_radius(), 0);
      }

      bool contains(const Point &X) const
      {
        for (unsigned int side = 0; side < 6; ++side)
          if (outward(side) * X > inner_radius() + flush * radius)
            return false;
        return true;
      }

      /// Two convex polygons are apart if and only if a side of one of them separates them.
      Side classify(const Box &box) const
      {
        const auto &[low, high] = box.get_boundary_points();
        const Point extents     = extent();
        const double tolerance  = flush * radius;
        bool inside             = true;
        bool outside            = false;
        for (unsigned int d = 0; d < 2; ++d)
          outside =
            outside || high[d] <= -extents[d] + tolerance || low[d] >= extents[d] - tolerance;
        for (unsigned int side = 0; side < 6; ++side)
        {
          const Direction n = outward(side);
          double nearest = 0, farthest = 0;
          for (unsigned int d = 0; d < 2; ++d)
          {
            nearest += std::min(n[d] * low[d], n[d] * high[d]);
            farthest += std::max(n[d] * low[d], n[d] * high[d]);
          }
          inside  = inside && farthest <= inner_radius() + tolerance;
          outside = outside || nearest >= inner_radius() - tolerance;
        }
        return either(inside, outside);
      }

      /// Clips the box's rectangle by the six sides.
      double area_in(const Box &box) const
      {
        const auto &[low, high]    = box.get_boundary_points();
        std::vector<Point> polygon = {Point(low[0], low[1], 0), Point(high[0], low[1], 0),
                                      Point(high[0], high[1], 0), Point(low[0], high[1], 0)};
        for (unsigned int side = 0; side < 6; ++side)
        {
          std::vector<Point> kept;
          for (std::size_t i = 0; i < polygon.size(); ++i)
          {
            const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double above_a = outward(side) * a - inner_radius(),
                         above_b = outward(side) * b - inner_radius();
            if (above_a <= 0)
              kept.push_back(a);
            if ((above_a < 0 && above_b > 0) || (above_a > 0 && above_b < 0))
              kept.push_back(a + (b - a) * (above_a / (above_a - above_b)));
          }
          polygon = std::move(kept);
        }
        double twice_the_area = 0;
        for (std::size_t i = 2; i < polygon.size(); ++i)
          twice_the_area +=
            dealii::cross_product_3d(polygon[i - 1] - polygon[0], polygon[i] - polygon[0])[2];
        return 0.5 * twice_the_area;
      }

      double area() const
      {
        return 1.5 * std::sqrt(3.) * radius * radius;
      }

      Rings rings() const
      {
        return make_rings(Point(), 6, 16, [&](const unsigned int k, const unsigned int j) {
          const Point &a = corners[j / k], &b = corners[(j / k + 1) % 6];
          return Point((a + (b - a) * (double(j % k) / k)) * (k / 16.));
        });
      }

      BoundaryPoint on_boundary(const Point &X, const Direction &normal, bool /*is_side*/) const
      {
        return {X, normal};
      }

      double inner_radius() const
      {
        return std::sqrt(0.75) * radius;
      }

      Direction outward(const unsigned int side) const
      {
        return (corners[side] + corners[(side + 1) % 6]) / (2 * inner_radius());
      }

      const double radius;
      std::array<Point, 6> corners;
    };

    /// A section times 0 <= z <= length.
    template <class Section>
    class Prism final : public Shape
    {
    public:
      Prism(const double radius, const double length) : section_(radius), length_(length) {}

      Box bounding_box() const override
      {
        const Point extent = section_.extent();
        return Box({-extent, Point(extent[0], extent[1], length_)});
      }

      bool contains(const Point &X) const override
      {
        return in_range(X[2], length_) && section_.contains(Point(X[0], X[1], 0));
      }

      Side classify(const Box &box) const override
      {
        return both(section_.classify(box), side_of_range(box, 2, length_));
      }

      double filled_volume(const Box &box) const override
      {
        const double height = overlap(box, 2, 0, length_);
        return height > 0 ? height * section_.area_in(box) : 0;
      }

      double volume() const override
      {
        return length_ * section_.area();
      }

      BoundaryPoint
      on_boundary(const Point &X, const Direction &normal, const unsigned int patch) const override
      {
        return section_.on_boundary(X, normal, patch == 0);
      }

    private:
      /// The ends in rings, the side in rectangles about twice as high as wide.
      Surface make_surface() const override
      {
        const Rings base = section_.rings();
        Rings top        = base;
        for (auto &ring : top)
          for (Point &X : ring)
            X[2] = length_;
        TriangleList list;
        add_rings(list, base, false, 1);
        add_rings(list, top, true, 2);

        const std::vector<Point> &outline = base.back();
        const double width                = outline[0].distance(outline[1]);
        const unsigned int n_layers       = std::clamp(length_ / (2 * width), 1., 500.);
        const auto at                     = [&](Point X, const unsigned int layer) {
          X[2] = length_ * (double(layer) / n_layers); // exact at both ends
          return X;
        };
        for (unsigned int layer = 0; layer < n_layers; ++layer)
          for (unsigned int j = 0; j < outline.size(); ++j)
          {
            const Point &a = outline[j], &b = outline[(j + 1) % outline.size()];
            list.add(at(a, layer), at(b, layer), at(b, layer + 1), at(a, layer + 1), 0);
          }
        return list.finish();
      }

      const Section section_;
      const double length_;
    };
  } // namespace

  std::unique_ptr<Body> make_box(const Point &size)
  {
    return std::make_unique<BoxBody>(size);
  }

  std::unique_ptr<Body> make_cylinder(const double radius, const double length)
  {
    return std::make_unique<Prism<Disk>>(radius, length);
  }

  std::unique_ptr<Body> make_hexagonal_prism(const double radius, const double length)
  {
    return std::make_unique<Prism<Hexagon>>(radius, length);
  }
} // namespace softcell
