// SPDX-License-Identifier: LGPL-2.1-or-later
// What the threads of a batch of flat patches do, for host and device.
#pragma once

#include "cell_kernels.h"

#include <softcell/operators/flat_arrays.h>

namespace softcell
{
  /// A row and what belongs to it.
  template <class Real>
  struct ThreadPoint
  {
    std::size_t batch;
    int lane;

    /// Of an array (batches, width).
    SOFTCELL_HOST_DEVICE std::size_t entry() const
    {
      return batch * card_width + lane;
    }
    /// Of an array (batches, 9, width).
    SOFTCELL_HOST_DEVICE std::size_t matrix() const
    {
      return batch * 9 * card_width + lane;
    }
  };

  template <class Real>
  SOFTCELL_HOST_DEVICE Matrix3<Real> load_matrix(const Real *const matrices,
                                                 const std::size_t first)
  {
    Matrix3<Real> result;
    for (int k = 0; k < 9; ++k)
      result.entries[k] = matrices[first + k * card_width];
    return result;
  }

  template <class Real>
  SOFTCELL_HOST_DEVICE void
  store_matrix(const Matrix3<Real> &matrix, Real *const matrices, const std::size_t first)
  {
    for (int k = 0; k < 9; ++k)
      matrices[first + k * card_width] = matrix.entries[k];
  }

  /// What is kept at points.
  template <class Real>
  struct PointData
  {
    const Real *weights;
    Real *F, *stresses; // (batches, 9, width)
    Real *pressures;    // (batches, width)
    int *n_inverted;    // (batches, width)
  };

  /// The tangent at a point, times its weight.
  template <class Real, class Law>
  SOFTCELL_HOST_DEVICE auto
  weighted_tangent(const Law &law, const PointData<Real> &data, const ThreadPoint<Real> &point)
  {
    const Law own_law = weighted(law, data.weights[point.entry()]);
    auto tangent =
      own_law.linearisation(load_matrix(data.F, point.matrix()),
                            data.weights[point.entry()] * data.pressures[point.entry()]);
    tangent.lambda = own_law.lambda;
    return tangent;
  }

  /// Takes F from the gradient H, and the pressure.
  template <class Real, class Law>
  struct StateAction
  {
    static constexpr bool needs_gradient = true;

    SOFTCELL_HOST_DEVICE void operator()(const Law &law,
                                         const PointData<Real> &data,
                                         const ThreadPoint<Real> &point,
                                         const Matrix3<Real> &H) const
    {
      const Matrix3<Real> F = H + identity<Real>();
      store_matrix(F, data.F, point.matrix());
      data.pressures[point.entry()]  = law.lambda * law.volumetric_strain(F);
      data.n_inverted[point.entry()] = law.is_admissible(determinant(F)) ? 0 : 1;
    }
  };

  template <class Real, class Law>
  struct FlatResidualAction
  {
    static constexpr bool needs_gradient = false;

    SOFTCELL_HOST_DEVICE void operator()(const Law &law,
                                         const PointData<Real> &data,
                                         const ThreadPoint<Real> &point,
                                         const Matrix3<Real> & /*H*/) const
    {
      const Matrix3<Real> P =
        law.first_piola_stress(load_matrix(data.F, point.matrix()), data.pressures[point.entry()]);
      store_matrix(data.weights[point.entry()] * P, data.stresses, point.matrix());
    }
  };

  template <class Real, class Law>
  struct FlatTangentAction
  {
    static constexpr bool needs_gradient = true;

    SOFTCELL_HOST_DEVICE void operator()(const Law &law,
                                         const PointData<Real> &data,
                                         const ThreadPoint<Real> &point,
                                         const Matrix3<Real> &dF) const
    {
      store_matrix(weighted_tangent(law, data, point)(dF), data.stresses, point.matrix());
    }
  };

  /// Runs an action in batches of points of one material.
  template <class Real, class Law, template <class, class> class Action>
  struct PointKernel
  {
    using Scratch = char;

    static constexpr int n_threads = card_width, n_phases = 1, n_scratch = 0;

    Law law;
    PointData<Real> data;
    RowArrays<Real> rows;
    const unsigned int *batches; // (blocks)
    Components<const Real> x;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const ThreadPoint<Real> point{batches[block], thread};
      const Action<Real, Law> action{};
      if constexpr (Action<Real, Law>::needs_gradient)
        action(law, data, point, gradient(point));
      else
        action(law, data, point, {});
    }

    SOFTCELL_HOST_DEVICE Matrix3<Real> gradient(const ThreadPoint<Real> &point) const
    {
      Matrix3<Real> H{};
      const std::size_t first   = rows.starts[point.batch];
      const unsigned int length = rows.lengths[point.batch];
      for (unsigned int k = 0; k < length; ++k)
      {
        const unsigned int node = rows.numbers[(first + k) * card_width + point.lane];
        for (int c = 0; c < 3; ++c)
        {
          const Real x_c = x.component[c][node];
          for (int A = 0; A < 3; ++A)
            H(c, A) += x_c * rows.gradients[((first + k) * 3 + A) * card_width + point.lane];
        }
      }
      return H;
    }
  };

  /// Sums the stresses of a node's points up.
  template <class Real>
  struct StressSumKernel
  {
    using Scratch = char;

    static constexpr int n_threads = card_width, n_phases = 1, n_scratch = 0;

    RowArrays<Real> rows;
    const Real *stresses;
    unsigned int n_nodes;
    Components<Real> y;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const std::size_t first   = rows.starts[block];
      const unsigned int length = rows.lengths[block], node = block * card_width + thread;
      Real sums[3] = {};
      for (unsigned int k = 0; k < length; ++k)
      {
        const Matrix3<Real> P =
          load_matrix(stresses, rows.numbers[(first + k) * card_width + thread]);
        Real g[3];
        for (int A = 0; A < 3; ++A)
          g[A] = rows.gradients[((first + k) * 3 + A) * card_width + thread];
        for (int c = 0; c < 3; ++c)
          sums[c] += dot(P, c, g);
      }
      if (node < n_nodes)
        for (int c = 0; c < 3; ++c)
          y.component[c][node] = sums[c];
    }
  };

  /// Puts rows that were sent into their places, one in each block.
  template <class Real>
  struct ChangeKernel
  {
    using Scratch = char;
    using Row     = typename RowChanges<Real>::Row;

    static constexpr int n_threads = card_width, n_phases = 1, n_scratch = 0;

    struct Target
    {
      unsigned int *lengths, *numbers;
      Real *gradients;
    };

    const Row *rows;
    const unsigned int *numbers;
    const Real *gradients;
    Target points, nodes;
    Real *weights;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const Row &row                 = rows[block];
      const std::size_t lane         = row.row % card_width;
      unsigned int *const to_numbers = row.is_point ? points.numbers : nodes.numbers;
      Real *const to_gradients       = row.is_point ? points.gradients : nodes.gradients;
      unsigned int *const to_lengths = row.is_point ? points.lengths : nodes.lengths;
      for (unsigned int k = thread; k < row.room; k += n_threads)
      {
        to_numbers[(row.first + k) * card_width + lane] = numbers[row.offset + k];
        for (int d = 0; d < 3; ++d)
          to_gradients[((row.first + k) * 3 + d) * card_width + lane] =
            gradients[3 * (row.offset + k) + d];
      }
      if (thread == 0) // rows of one batch write the same length
      {
        to_lengths[row.row / card_width] = row.length;
        if (row.is_point)
          weights[row.row] = row.weight;
      }
    }
  };
} // namespace softcell
