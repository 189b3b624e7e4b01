// SPDX-License-Identifier: LGPL-2.1-or-later
// How far the shapes of a discretization are from reproducing linear functions.
#pragma once

#include <softcell/discretization/discretization.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace softcell
{
  /// Largest violation of sum N = 1, sum grad N = 0, sum X N = X, sum X grad N = I over all points.
  inline double linear_defect(const Discretization &cells)
  {
    PatchStorage storage;
    std::vector<Point> points;
    double defect = 0;
    for (unsigned int i = 0; i < cells.n_patches(); ++i)
    {
      const Patch patch = cells.patch(i, storage);
      cells.patch_points(i, points);
      EXPECT_EQ(points.size(), patch.n_points());
      for (unsigned int q = 0; q < patch.n_points(); ++q)
      {
        double unity = -1;
        Direction X  = -1. * points[q], none;
        dealii::Tensor<2, 3> F;
        for (unsigned int k = 0; k < patch.n_nodes(); ++k)
        {
          const double N = patch.shapes->value(q)[k];
          const Point &Y = cells.node_positions()[patch.nodes[k]];
          unity += N;
          X += N * Y;
          for (unsigned int d = 0; d < 3; ++d)
          {
            const double dN = patch.shapes->gradient(q)[d * patch.n_nodes() + k];
            none[d] += dN;
            for (unsigned int c = 0; c < 3; ++c)
              F[c][d] += Y[c] * dN;
          }
        }
        for (unsigned int d = 0; d < 3; ++d)
          F[d][d] -= 1;
        defect = std::max({defect, std::abs(unity), X.norm(), none.norm(), F.norm()});
      }
    }
    return dealii::Utilities::MPI::max(defect, MPI_COMM_WORLD);
  }
} // namespace softcell
