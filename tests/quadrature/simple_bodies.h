// SPDX-License-Identifier: LGPL-2.1-or-later
// Two bodies whose every answer is a formula.
#pragma once

#include <softcell/geometry/body.h>
#include <softcell/geometry/surface.h>

#include <cmath>

namespace softcell
{
  class Ball : public Body
  {
  public:
    explicit Ball(const double radius, const Point &centre = Point())
        : radius_(radius), centre_(centre)
    {
    }
    Box bounding_box() const override
    {
      const Direction r({radius_, radius_, radius_});
      return Box({centre_ - r, centre_ + r});
    }
    bool contains(const Point &X) const override
    {
      return X.distance(centre_) < radius_;
    }
    Side classify(const Box &box) const override
    {
      Direction nearest, farthest;
      for (unsigned int d = 0; d < 3; ++d)
      {
        const double a = box.lower_bound(d) - centre_[d], b = box.upper_bound(d) - centre_[d];
        nearest[d]  = std::max({a, -b, 0.});
        farthest[d] = std::max(std::abs(a), std::abs(b));
      }
      return farthest.norm() < radius_  ? Side::inside
             : nearest.norm() > radius_ ? Side::outside
                                        : Side::cut;
    }
    double
    filled_volume(const Box &box) const override // full where cut: enough for the sparse grid
    {
      return classify(box) == Side::outside ? 0 : box.volume();
    }
    double volume() const override
    {
      return 4. / 3 * M_PI * std::pow(radius_, 3);
    }
    const Surface &surface() const override
    {
      throw dealii::ExcNotImplemented();
    }

  private:
    double radius_;
    Point centre_;
  };

  /// Label 1 beyond x = split, 0 before.
  class Brick : public Body
  {
  public:
    explicit Brick(const Box &box, const double split = 1e300) : box_(box), split_(split) {}
    Box bounding_box() const override
    {
      return box_;
    }
    bool contains(const Point &X) const override
    {
      return box_.point_inside(X, 0.);
    }
    Side classify(const Box &box) const override
    {
      const double filled       = filled_volume(box);
      const bool has_two_labels = box.lower_bound(0) < split_ && split_ < box.upper_bound(0);
      return filled <= 0                               ? Side::outside
             : filled < box.volume() || has_two_labels ? Side::cut
                                                       : Side::inside;
    }
    double filled_volume(const Box &box) const override
    {
      double v = 1;
      for (unsigned int d = 0; d < 3; ++d)
        v *= std::max(0., std::min(box.upper_bound(d), box_.upper_bound(d)) -
                            std::max(box.lower_bound(d), box_.lower_bound(d)));
      return v;
    }
    double volume() const override
    {
      return box_.volume();
    }
    const Surface &surface() const override
    {
      throw dealii::ExcNotImplemented();
    }
    unsigned int n_labels() const override
    {
      return split_ < 1e300 ? 2 : 1;
    }
    unsigned int label(const Point &X) const override
    {
      return X[0] > split_;
    }

  private:
    Box box_;
    double split_;
  };
} // namespace softcell
