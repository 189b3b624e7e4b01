// SPDX-License-Identifier: LGPL-2.1-or-later
// The tridiagonal matrix that conjugate gradients make along their way.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace softcell
{
  /// Its eigenvalues lie between the extreme ones of the preconditioned matrix, and the outer ones
  /// come near to these. Source: Saad, Iterative Methods for Sparse Linear Systems (2003),
  /// sec. 6.7.3.
  class LanczosMatrix
  {
  public:
    void clear();

    /// After a step along p of length r.z / p.Ap.
    /// @param curvature p.Ap / r.z
    /// @param share     of the last direction in p.
    void add(double curvature, double share);

    /// NaN if it has no rows.
    std::pair<double, double> extreme_eigenvalues() const;

  private:
    std::vector<double> diagonal_, beside_diagonal_; // the latter with the row before
    double last_curvature_ = 0;
  };

  /// Steps of conjugate gradients on a random field from which a smoother estimates its largest
  /// eigenvalue, and the factor for what they miss. Half as many miss the stiffness of single cells
  /// that are squeezed flat, which the smoother would amplify.
  constexpr unsigned int n_eigenvalue_steps = 16;
  constexpr double eigenvalue_margin        = 1.05;
} // namespace softcell
