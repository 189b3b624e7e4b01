// SPDX-License-Identifier: LGPL-2.1-or-later
// Few points that integrate as many do.
#pragma once

#include <softcell/base/types.h>

#include <vector>

namespace softcell
{
  /// Replaces a rule of many points by one of (p + 1)^3 points with the same moments.
  ///
  /// The moments are the integrals of all that products of the gradients of tensor shapes of degree
  /// p consist of: the monomials whose exponents are at most 2p, but for those in which two are 2p
  /// and the third is larger than 2p - 2. At p = 1 these are 23, among them the 7 of the gradients
  /// themselves, and eight points have 32 free numbers: their places and their weights. Sought is a
  /// rule of
  /// - weights of at least a tenth of their mean, and
  /// - points in the smallest box around the many,
  /// whose moments, in Legendre polynomials orthonormal in that box and with those of total degree
  /// d counted 2^-d, differ little. The search, that of Levenberg and Marquardt, starts from the
  /// Gauss points of the cube, mapped by the root of the covariance: but for the bounds they have
  /// the volume, the centroid and the second moments of the many. It ends where an iteration gains
  /// less than 1 %, which need not be a minimum. Where it misses some moments, a short last step
  /// goes for the volume and the other moments of the gradients themselves.
  ///
  /// The many points stay where these still differ by more than the lightest of them weighs: by as
  /// much as the many themselves do not know, for a body's boundary may lie anywhere between them.
  ///
  /// At p = 1 nearly all cut cells get all moments to rounding, and so the stiffness at small
  /// strain that the many points give; where not, the search is tried again from Gauss points
  /// twisted about each axis. From p = 2 on there is one start only, since there are more moments
  /// than free numbers: 121, 108.
  class Compression
  {
  public:
    /// @param degree p of the shape functions.
    explicit Compression(unsigned int degree);

    /// Rules of at most (p + 1)^3 points stay as they are.
    /// @param weights positive.
    /// @return root of the sum of squares of the moments' misfits, relative to the volume; 0 where
    ///         the points stay.
    double compress(std::vector<Point> &points, std::vector<double> &weights) const;

  private:
    class Search;

    struct Moment
    {
      unsigned int x, y, z;    // degrees of the Legendre polynomials
      bool is_of_one_gradient; // and not only of products
    };

    const unsigned int degree_;
    std::vector<Moment> moments_;
    std::vector<std::vector<Point>> starts_; // of zero mean and unit covariance
    std::vector<double> start_weights_;      // of sum 1
  };
} // namespace softcell
