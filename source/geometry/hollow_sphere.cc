// SPDX-License-Identifier: LGPL-2.1-or-later
// A ball less the ball of smaller radius about the same centre.

#include <softcell/geometry/shape.h>
#include <softcell/geometry/shapes.h>

namespace softcell
{
  namespace
  {
    class HollowSphere final : public Shape
    {
    public:
      HollowSphere(const double radius, const double inner_radius)
          : rise_({0, 0, radius - inner_radius}),
            ball_(make_sphere(radius)),
            cavity_(make_sphere(inner_radius))
      {
      }

      Box bounding_box() const override
      {
        return ball_->bounding_box();
      }

      bool contains(const Point &X) const override
      {
        return ball_->contains(X) && cavity_->classify(Box({X - rise_, X - rise_})) != Side::inside;
      }

      Side classify(const Box &box) const override
      {
        const Side of_ball = ball_->classify(box), of_cavity = cavity_->classify(lowered(box));
        if (of_ball == Side::outside || of_cavity == Side::inside)
          return Side::outside;
        return of_ball == Side::inside && of_cavity == Side::outside ? Side::inside : Side::cut;
      }

      double filled_volume(const Box &box) const override
      {
        return ball_->filled_volume(box) - cavity_->filled_volume(lowered(box));
      }

      double volume() const override
      {
        return ball_->volume() - cavity_->volume();
      }

      BoundaryPoint
      on_boundary(const Point &X, const Direction &normal, const unsigned int patch) const override
      {
        if (patch == 0)
          return ball_->on_boundary(X, normal, 0);
        BoundaryPoint point = cavity_->on_boundary(X - rise_, -normal, 0);
        point.X += rise_;
        point.normal *= -1.;
        return point;
      }

    private:
      Box lowered(const Box &box) const
      {
        const auto &[low, high] = box.get_boundary_points();
        return Box({low - rise_, high - rise_});
      }

      Surface make_surface() const override
      {
        TriangleList list;
        for (unsigned int t = 0; t < ball_->surface().triangles().size(); ++t)
        {
          const auto [a, b, c] = ball_->surface().corners(t);
          list.add(a, b, c, 0);
        }
        for (unsigned int t = 0; t < cavity_->surface().triangles().size(); ++t)
        {
          const auto [a, b, c] = cavity_->surface().corners(t);
          list.add(a + rise_, c + rise_, b + rise_, 1);
        }
        return list.finish();
      }

      const Direction rise_; // of the cavity, which would else stand on z = 0
      const std::unique_ptr<Body> ball_, cavity_;
    };
  } // namespace

  std::unique_ptr<Body> make_hollow_sphere(const double radius, const double inner_radius)
  {
    return std::make_unique<HollowSphere>(radius, inner_radius);
  }
} // namespace softcell
