// SPDX-License-Identifier: LGPL-2.1-or-later
// Polynomials that are orthonormal under the quadrature of a cell.
#pragma once

#include <softcell/base/types.h>

#include <vector>

namespace softcell
{
  /// Appends polynomials phi_k up to a degree with sum_q w_q phi_k(X_q) phi_l(X_q) = delta_kl, at
  /// all points, one polynomial after the other. Those that the weighted points can hardly tell
  /// from others are left out; so are all where no point has a weight.
  /// @param points  (n_points); at degree 0 only their number matters.
  /// @param weights (at most n_points) of the first points; the others are evaluated alone.
  /// @param values  (n_polynomials, n_points) behind what it holds. Units: m^(-3/2)
  void orthonormal_polynomials(const std::vector<Point> &points,
                               View<const double> weights,
                               unsigned int degree,
                               std::vector<double> &values);
} // namespace softcell
