// SPDX-License-Identifier: LGPL-2.1-or-later
// Lagrange shape functions of any degree on boxes.

#include <softcell/discretization/tensor_shapes.h>

#include <deal.II/base/quadrature_lib.h>

namespace softcell
{
  TensorShapes::TensorShapes(const unsigned int degree)
  {
    const dealii::QGaussLobatto<1> rule(degree + 1);
    for (const auto &x : rule.get_points())
      line_.push_back(x[0]);
  }

  Point TensorShapes::node(const unsigned int i) const
  {
    const unsigned int n = line_.size();
    return Point(line_[i % n], line_[i / n % n], line_[i / (n * n)]);
  }

  void TensorShapes::evaluate_line(const double x, double *values, double *derivatives) const
  {
    for (unsigned int i = 0; i < line_.size(); ++i)
    {
      double v = 1, d = 0;
      for (unsigned int j = 0; j < line_.size(); ++j)
        if (j != i)
        {
          const double scale = 1 / (line_[i] - line_[j]);
          d                  = (d * (x - line_[j]) + v) * scale;
          v *= (x - line_[j]) * scale;
        }
      values[i]      = v;
      derivatives[i] = d;
    }
  }

  void TensorShapes::evaluate(const std::vector<Point> &points,
                              const Direction &size,
                              ShapeTable &table) const
  {
    const unsigned int n = line_.size();
    table.resize(points.size(), n * n * n);
    std::vector<double> lines(6 * n); // values along x, y, z, then derivatives
    double *const value      = lines.data();
    double *const derivative = value + 3 * n;
    for (unsigned int q = 0; q < points.size(); ++q)
    {
      for (unsigned int d = 0; d < 3; ++d)
      {
        evaluate_line(points[q][d], value + d * n, derivative + d * n);
        for (unsigned int i = 0; i < n; ++i)
          derivative[d * n + i] /= size[d];
      }
      double *N  = table.values.data() + q * n * n * n;
      double *Nx = table.gradients.data() + 3 * q * n * n * n, *Ny = Nx + n * n * n,
             *Nz = Ny + n * n * n;
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int j = 0; j < n; ++j)
        {
          const double yz   = value[n + j] * value[2 * n + k];
          const double dy_z = derivative[n + j] * value[2 * n + k];
          const double y_dz = value[n + j] * derivative[2 * n + k];
          for (unsigned int i = 0; i < n; ++i)
          {
            *N++  = value[i] * yz;
            *Nx++ = derivative[i] * yz;
            *Ny++ = value[i] * dy_z;
            *Nz++ = value[i] * y_dz;
          }
        }
    }
  }
} // namespace softcell
