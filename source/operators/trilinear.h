// SPDX-License-Identifier: LGPL-2.1-or-later
// Derivatives of trilinear functions at the points of a cell, and the transposed sums; for host and
// device, for one cell or a pack of them.
#pragma once

#include <softcell/mechanics/tensor.h>

namespace softcell
{
  /// Values at a cell's corners, along x first.
  template <class Number>
  using Corners = Number[8];

  /// One of the 8 Gauss points of the cube [-1, 1]^3, along x first.
  template <class Real>
  struct GaussPoint
  {
    static constexpr Real distance =
      Real(0.57735026918962576451L); // from the middle along each axis

    int number;

    SOFTCELL_HOST_DEVICE Real place(const int axis) const
    {
      return (number >> axis) & 1 ? distance : -distance;
    }
  };

  /// A point of the cube [-1, 1]^3.
  template <class Number>
  struct CubePoint
  {
    Number x[3];

    SOFTCELL_HOST_DEVICE const Number &place(const int axis) const
    {
      return x[axis];
    }
  };

  /// The derivatives of a trilinear function at the Gauss points of a cell, or what is summed up
  /// there to be multiplied by the derivatives of the corners' shapes.
  ///
  /// The derivative along an axis is the same at points in line along it: it has four values.
  /// `Values` is where they are kept.
  template <class Number, class Real, class Values = Number[3][4]>
  class GaussGradients
  {
  public:
    /// @param scale  by axis, an eighth of the derivative of the cube's coordinate along it.
    SOFTCELL_HOST_DEVICE explicit GaussGradients(const Real *scale) : scale_(scale) {}
    SOFTCELL_HOST_DEVICE GaussGradients(const Real *scale, const Values &values)
        : scale_(scale), values_(values)
    {
    }

    /// Takes the derivatives of the function with the values v at the corners.
    SOFTCELL_HOST_DEVICE void evaluate(const Corners<Number> &v)
    {
      Number d[4], lower[4], upper[4]; // along x: differences, and values at the points
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i)
        d[i] = interpolate(v[2 * i], v[2 * i + 1], lower[i], upper[i]);
      Number e[4];
      interpolate(d[0], d[1], e[0], e[1]);
      interpolate(d[2], d[3], e[2], e[3]);
      interpolate(e[0], e[2], values_[0][0], values_[0][2], scale_[0]);
      interpolate(e[1], e[3], values_[0][1], values_[0][3], scale_[0]);
      interpolate(lower[1] - lower[0], lower[3] - lower[2], values_[1][0], values_[1][2],
                  scale_[1]);
      interpolate(upper[1] - upper[0], upper[3] - upper[2], values_[1][1], values_[1][3],
                  scale_[1]);
      interpolate(lower[2] - lower[0], lower[3] - lower[1], values_[2][0], values_[2][2],
                  scale_[2]);
      interpolate(upper[2] - upper[0], upper[3] - upper[1], values_[2][1], values_[2][3],
                  scale_[2]);
    }

    SOFTCELL_HOST_DEVICE const Number &derivative(const GaussPoint<Real> q, const int axis) const
    {
      return values_[axis][line(q, axis)];
    }

    /// Points are added in their order.
    SOFTCELL_HOST_DEVICE void add(const GaussPoint<Real> q, const int axis, const Number &value)
    {
      if ((q.number >> axis) & 1)
        values_[axis][line(q, axis)] += value;
      else
        values_[axis][line(q, axis)] = value;
    }

    /// The sums of what was added times the derivatives of the corners' shapes: the transpose of
    /// evaluate(). Call it once.
    SOFTCELL_HOST_DEVICE void integrate(Corners<Number> &v)
    {
      Number d[4], e[4];
      interpolate(values_[0][0], values_[0][2], e[0], e[2], scale_[0]);
      interpolate(values_[0][1], values_[0][3], e[1], e[3], scale_[0]);
      interpolate(e[0], e[1], d[0], d[1]);
      interpolate(e[2], e[3], d[2], d[3]);
      Number lower[4], upper[4];
      integrate_side(lower, 0);
      integrate_side(upper, 1);
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i)
      {
        interpolate(lower[i], upper[i], v[2 * i], v[2 * i + 1]);
        v[2 * i] -= d[i];
        v[2 * i + 1] += d[i];
      }
    }

  private:
    SOFTCELL_HOST_DEVICE static int line(const GaussPoint<Real> q, const int axis)
    {
      return axis == 0   ? q.number >> 1
             : axis == 1 ? (q.number & 1) | (q.number >> 2 << 1)
                         : q.number & 3;
    }

    /// Twice the values at the Gauss points of what is a at -1 and b at 1. It is its own transpose.
    /// @return b - a.
    SOFTCELL_HOST_DEVICE static Number
    interpolate(const Number &a, const Number &b, Number &lower, Number &upper)
    {
      constexpr Real s = GaussPoint<Real>::distance;
      const Number m = a + b, d = b - a;
      lower = m - s * d;
      upper = m + s * d;
      return d;
    }

    /// The same times a factor.
    SOFTCELL_HOST_DEVICE static void
    interpolate(const Number &a, const Number &b, Number &lower, Number &upper, const Real factor)
    {
      const Real s   = factor * GaussPoint<Real>::distance;
      const Number m = factor * (a + b), d = b - a;
      lower = m - s * d;
      upper = m + s * d;
    }

    /// What the derivatives along y and z at the points of lower or upper x add to four corners.
    SOFTCELL_HOST_DEVICE void integrate_side(Number (&corners)[4], const int x) const
    {
      Number y0, y1, z0, z1;
      interpolate(values_[1][x], values_[1][x + 2], y0, y1, scale_[1]);
      interpolate(values_[2][x], values_[2][x + 2], z0, z1, scale_[2]);
      corners[0] = -y0 - z0;
      corners[1] = y0 - z1;
      corners[2] = z0 - y1;
      corners[3] = y1 + z1;
    }

    const Real *scale_;
    Values values_; // by axis and line
  };

  /// The same at any points: by the coefficients of the products of the cube's coordinates.
  template <class Number, class Real>
  class PointGradients
  {
  public:
    SOFTCELL_HOST_DEVICE explicit PointGradients(const Real *scale) : scale_(scale)
    {
      for (Number &c : coefficients_)
        c = Number(0);
    }

    SOFTCELL_HOST_DEVICE void evaluate(const Corners<Number> &v)
    {
      for (int i = 0; i < 8; ++i)
        coefficients_[i] = v[i];
      for (int axis = 1; axis < 8; axis *= 2)
        for (int i = 0; i < 8; ++i)
          if ((i & axis) == 0)
          {
            const Number lower = coefficients_[i], upper = coefficients_[i + axis];
            coefficients_[i]        = upper + lower;
            coefficients_[i + axis] = upper - lower;
          }
    }

    SOFTCELL_HOST_DEVICE Number derivative(const CubePoint<Number> &p, const int axis) const
    {
      const int a = 1 << axis, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
      const Number &y = p.x[(axis + 1) % 3], &z = p.x[(axis + 2) % 3];
      return scale_[axis] * (coefficients_[a] + coefficients_[a + b] * y +
                             (coefficients_[a + c] + coefficients_[7] * y) * z);
    }

    SOFTCELL_HOST_DEVICE void add(const CubePoint<Number> &p, const int axis, const Number &value)
    {
      const int a = 1 << axis, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
      const Number &y = p.x[(axis + 1) % 3], &z = p.x[(axis + 2) % 3];
      const Number scaled = scale_[axis] * value, z_scaled = z * scaled;
      coefficients_[a] += scaled;
      coefficients_[a + b] += y * scaled;
      coefficients_[a + c] += z_scaled;
      coefficients_[7] += y * z_scaled;
    }

    SOFTCELL_HOST_DEVICE void integrate(Corners<Number> &v) const
    {
      for (int i = 0; i < 8; ++i)
        v[i] = coefficients_[i];
      for (int axis = 1; axis < 8; axis *= 2)
        for (int i = 0; i < 8; ++i)
          if ((i & axis) == 0)
          {
            const Number even = v[i], odd = v[i + axis];
            v[i]        = even - odd;
            v[i + axis] = even + odd;
          }
    }

  private:
    const Real *scale_;
    Number coefficients_[8]; // by the coordinates in the product: x 1, y 2, z 4, xy 3, ...
  };
} // namespace softcell
