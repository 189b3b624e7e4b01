// SPDX-License-Identifier: LGPL-2.1-or-later
// The tridiagonal matrix that conjugate gradients make along their way.

#include <softcell/solvers/lanczos.h>

#include <deal.II/lac/tridiagonal_matrix.h>

#include <cmath>
#include <limits>

namespace softcell
{
  void LanczosMatrix::clear()
  {
    diagonal_.clear();
    beside_diagonal_.clear();
  }

  void LanczosMatrix::add(const double curvature, const double share)
  {
    const double before = diagonal_.empty() ? 0 : last_curvature_;
    diagonal_.push_back(curvature + share * before);
    beside_diagonal_.push_back(std::sqrt(share) * before);
    last_curvature_ = curvature;
  }

  std::pair<double, double> LanczosMatrix::extreme_eigenvalues() const
  {
    const unsigned int n = diagonal_.size();
    if (n == 0)
      return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    dealii::TridiagonalMatrix<double> matrix(n, true);
    for (unsigned int i = 0; i < n; ++i)
    {
      matrix(i, i) = diagonal_[i];
      if (i > 0)
        matrix(i, i - 1) = beside_diagonal_[i];
    }
    matrix.compute_eigenvalues();
    return {matrix.eigenvalue(0), matrix.eigenvalue(n - 1)};
  }
} // namespace softcell
