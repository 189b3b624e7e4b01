// SPDX-License-Identifier: LGPL-2.1-or-later
// Lagrange shape functions of any degree on boxes.
#pragma once

#include <softcell/discretization/patch.h>

#include <vector>

namespace softcell
{
  /// Products of Lagrange polynomials on Gauss-Lobatto points along x, y and z. Nodes are numbered
  /// along x first, then along y, then along z.
  class TensorShapes
  {
  public:
    explicit TensorShapes(unsigned int degree);

    unsigned int degree() const
    {
      return line_.size() - 1;
    }
    unsigned int n_nodes() const
    {
      return line_.size() * line_.size() * line_.size();
    }
    /// Position of a node in the unit cube.
    Point node(unsigned int i) const;

    /// Shapes at points of a box, which are given in the unit cube or beyond it.
    /// @param size  edge lengths of the box. Units: m
    void evaluate(const std::vector<Point> &points, const Direction &size, ShapeTable &table) const;

  private:
    /// Values and derivatives of all polynomials at x.
    void evaluate_line(double x, double *values, double *derivatives) const;

    std::vector<double> line_; // the points in [0, 1]
  };
} // namespace softcell
