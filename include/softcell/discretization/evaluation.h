// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement at points: from shapes at hand, or wherever in the partition the points' cells
// lie.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/tensor.h>

#include <vector>

namespace softcell
{
  using Gradient = dealii::Tensor<2, 3>;

  /// u = sum_i N_i u_i at a point.
  /// @param nodes  (n) local node numbers.
  /// @param shapes (n) N_i.
  /// @param u      with ghost values.
  inline Direction
  interpolate(const View<const unsigned int> nodes, const double *const shapes, const Vector &u)
  {
    Direction value;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        value[c] += shapes[i] * u.local_element(3 * nodes[i] + c);
    return value;
  }

  /// [c][d] = du_c/dX_d at a point. Units: 1
  /// @param gradients (3, n) dN_i/dX_d.
  inline Gradient interpolate_gradient(const View<const unsigned int> nodes,
                                       const double *const gradients,
                                       const Vector &u)
  {
    const unsigned int n = nodes.size();
    Gradient value;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          value[c][d] += gradients[d * n + i] * u.local_element(3 * nodes[i] + c);
    return value;
  }

  /// F = I + H at a point whose displacement gradient is H.
  inline Matrix3<double> deformation_gradient(const Gradient &H)
  {
    Matrix3<double> F = identity<double>();
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = 0; d < 3; ++d)
        F(c, d) += H[c][d];
    return F;
  }

  /// A displacement with the discretization that it belongs to; both outlive it.
  struct DisplacementField
  {
    const Discretization &discretization;
    const Vector &u; // with ghost values
    double reach;    // that evaluate() gets. Units: m
  };

  /// Displacements at points in any order.
  struct PointValues
  {
    std::vector<Direction> displacements; // (n) 0 where nothing was found. Units: m
    std::vector<Gradient> gradients;      // (n) [c][d] = du_c/dX_d. Units: 1
    std::vector<double> distances;        // (n) of the point from the cell that answered: 0 in it,
                                          // infinity if no rank has a cell within reach. Units: m
  };

  /// The displacement at points whose cells may belong to any rank.
  ///
  /// Each rank asks for points of its own, as many as it likes; those ranks answer whose box holds
  /// the point. The cell with the strongest claim counts, the same on any number of ranks.
  /// Takes about 300 bytes a point while it works, so ask for millions of points in pieces.
  /// Collective.
  /// @param u     with ghost values.
  /// @param reach how far a point may lie outside all cells; its cell is extended then. Units: m
  PointValues evaluate(const Discretization &discretization,
                       const Vector &u,
                       const std::vector<Point> &points,
                       double reach);

  /// The displacement of one discretization of a body at the nodes of another; 0 at nodes beyond
  /// reach. Has ghost values. Collective.
  Vector
  transferred(const Discretization &from, const Vector &u, const Discretization &to, double reach);
} // namespace softcell
