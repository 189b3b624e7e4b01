// SPDX-License-Identifier: LGPL-2.1-or-later
// What the threads of a brick of cells do, for host and device.
#pragma once

#include "cell_diagonal.h"

#include <softcell/operators/cell_bricks.h>

namespace softcell
{
  /// Rows of numbers in what a brick's threads share, of which a thread has its own column.
  template <class Real, int row_length>
  struct SharedRows
  {
    Real *column;

    struct Row
    {
      Real *first;
      SOFTCELL_HOST_DEVICE Real &operator[](const int i) const
      {
        int place = i * CellBricks<Real>::n_cells;
#ifdef __CUDA_ARCH__
        asm volatile("" : "+r"(place)); // or the compiler keeps what is there in registers
#endif
        return first[place];
      }
    };
    SOFTCELL_HOST_DEVICE Row operator[](const int row) const
    {
      return {column + row * row_length * CellBricks<Real>::n_cells};
    }
  };

  /// A thread's cell, as cell_kernels.h wants it. What it adds to is its column of the corners'
  /// values.
  /// @tparam shares_state  the gradients of a tangent's displacement are in its column as well,
  /// which leaves registers for more blocks at once.
  template <class Real, bool shares_state>
  struct ThreadCell
  {
    using Number    = Real;
    using Gradients = GaussGradients<Real, Real>;

    const std::size_t *corners;
    std::size_t entry;   // of the lowest node
    std::size_t point;   // of its first number in arrays (bricks, 8, n_cells)
    const Real *weights; // of the first point; null if the brick's cells are full
    Real full_weight;
    Real *scratch; // the thread's column

    SOFTCELL_HOST_DEVICE void gather(const Real *const field, Corners<Real> &v) const
    {
      SOFTCELL_DEVICE_UNROLL
      for (int i = 0; i < 8; ++i)
        v[i] = field[entry + corners[i]];
    }

    SOFTCELL_HOST_DEVICE void add(const Corners<Real> &v, Real *const column) const
    {
      SOFTCELL_DEVICE_UNROLL
      for (int i = 0; i < 8; ++i)
        column[i * CellBricks<Real>::n_cells] = v[i];
    }

    SOFTCELL_HOST_DEVICE Real weight(const int q) const
    {
      return weights == nullptr ? full_weight : weights[q * CellBricks<Real>::n_cells];
    }

    SOFTCELL_HOST_DEVICE bool is_empty() const
    {
      Real sum = 0;
      SOFTCELL_DEVICE_UNROLL
      for (int q = 0; q < 8; ++q)
        sum += weight(q);
      return sum == 0;
    }

    template <class F>
    SOFTCELL_HOST_DEVICE void for_each_point(const F &f) const
    {
      SOFTCELL_DEVICE_UNROLL
      for (int q = 0; q < 8; ++q)
        f(GaussPoint<Real>{q}, point + q * CellBricks<Real>::n_cells, weight(q));
    }

    SOFTCELL_HOST_DEVICE static Real load(const Real *const numbers, const std::size_t number)
    {
      return numbers[number];
    }
    SOFTCELL_HOST_DEVICE static void
    store(const Real value, Real *const numbers, const std::size_t number)
    {
      numbers[number] = value;
    }
    SOFTCELL_HOST_DEVICE static Real log1p(const Real x)
    {
      using std::log1p;
      return log1p(x);
    }
    SOFTCELL_HOST_DEVICE static unsigned int count(const bool mask)
    {
      return mask ? 1 : 0;
    }
    SOFTCELL_HOST_DEVICE static void reset_where_empty(const Real weight, Matrix3<Real> &F)
    {
      if (weight == 0)
        F = identity<Real>();
    }
  };

  template <class Real>
  SOFTCELL_HOST_DEVICE auto state_gradients(const ThreadCell<Real, true> &cell,
                                            const CellGeometry<Real> &geometry)
  {
    using Values      = SharedRows<Real, 4>;
    using Gradients   = GaussGradients<Real, Real, Values>;
    const auto values = [&](const int c) {
      return Gradients(geometry.scale, Values{cell.scratch + c * 12 * CellBricks<Real>::n_cells});
    };
    return CellGradients<ThreadCell<Real, true>, Gradients>(values(0), values(1), values(2));
  }

  /// Runs an action in the cells of bricks. The action has
  ///   min_blocks                           of BrickKernel
  ///   n_values                             that it leaves at each corner, in `corners`: value k of
  ///                                        corner i in entry (8 k + i) n_cells
  ///   operator()(cell, geometry, corners)  returns how many points are turned inside out
  /// and says with `counts` whether those are counted, with `shares_state` see ThreadCell.
  template <class Real, class Action>
  struct BrickKernel
  {
    using Bricks  = CellBricks<Real>;
    using Scratch = Real;

    static constexpr int n_threads = Bricks::n_cells, n_phases = 2;
    static constexpr int n_state    = Action::shares_state ? 36 : 0;
    static constexpr int min_blocks = Action::min_blocks;
    static constexpr int count_row =
      Action::n_values * 8 > n_state ? Action::n_values * 8 : n_state;
    static constexpr int n_scratch = (count_row + (Action::counts ? 1 : 0)) * n_threads;

    CellGeometry<Real> geometry;
    Action action;
    int row, plane, n_bricks;
    const int *entries, *weight_packs;
    const Real *weights;
    Real *sums;      // (n_values, bricks, n_corners)
    int *n_inverted; // (bricks)

    SOFTCELL_HOST_DEVICE void
    operator()(const int phase, const int block, const int thread, Real *const scratch) const
    {
      if (phase == 0)
        cell_phase(block, thread, scratch);
      else
        node_phase(block, thread, scratch);
    }

    SOFTCELL_HOST_DEVICE void
    cell_phase(const int block, const int thread, Real *const scratch) const
    {
      const int pack       = weight_packs[block];
      const int x          = thread % Bricks::size[0];
      const int y          = thread / Bricks::size[0] % Bricks::size[1];
      const int z          = thread / (Bricks::size[0] * Bricks::size[1]);
      const std::size_t at = std::size_t(8) * n_threads;
      const ThreadCell<Real, Action::shares_state> cell{
        geometry.corners,    std::size_t(entries[block] + x + row * y + plane * z),
        block * at + thread, pack < 0 ? nullptr : weights + pack * at + thread,
        geometry.weight,     scratch + thread};
      unsigned int n = 0;
      if (!cell.is_empty())
        n = action(cell, geometry, cell.scratch);
      else
        for (int k = 0; k < 8 * Action::n_values; ++k)
          cell.scratch[k * n_threads] = 0;
      if constexpr (Action::counts)
        cell.scratch[count_row * n_threads] = Real(n);
    }

    SOFTCELL_HOST_DEVICE void
    node_phase(const int block, const int thread, const Real *const scratch) const
    {
      for (int node = thread; node < Bricks::n_corners; node += n_threads)
        for (int k = 0; k < Action::n_values; ++k)
          sums[(k * std::size_t(n_bricks) + block) * Bricks::n_corners + node] =
            sum(node, scratch + k * 8 * n_threads);
      if constexpr (Action::counts)
        if (thread == 0)
        {
          Real n = 0;
          for (int i = 0; i < n_threads; ++i)
            n += scratch[count_row * n_threads + i];
          n_inverted[block] = int(n);
        }
    }

    /// Of what the cells around a node have left.
    SOFTCELL_HOST_DEVICE static Real sum(const int node, const Real *const corners)
    {
      Real result = 0;
      SOFTCELL_DEVICE_UNROLL
      for (int i = 0; i < 8; ++i)
      {
        const int x = node % 9 - i % 2, y = node / 9 % 5 - i / 2 % 2, z = node / 45 - i / 4;
        if (x >= 0 && x < 8 && y >= 0 && y < 4 && z >= 0 && z < 4)
          result += corners[i * n_threads + x + 8 * (y + 4 * z)];
      }
      return result;
    }
  };

  /// As many blocks as the tangent has registers for without spills, or what the compiler takes.
  template <class Real, class Law>
  constexpr int tangent_blocks()
  {
    if (!has_costly_pressure<Law>)
      return 0;
    if (std::is_same_v<Real, float>)
      return 5;
    return std::is_same_v<Law, NeoHookean<Real>> ? 3 : 2;
  }

  template <class Real, class Law>
  struct TangentAction
  {
    static constexpr int n_values = 3, min_blocks = tangent_blocks<Real, Law>();
    static constexpr bool counts       = false;
    static constexpr bool shares_state = has_costly_pressure<Law>; // faster

    Law law;
    Components<const Real> u, x;
    PointModuli<const Real> moduli;

    SOFTCELL_HOST_DEVICE unsigned int operator()(const ThreadCell<Real, shares_state> &cell,
                                                 const CellGeometry<Real> &geometry,
                                                 Real *const corners) const
    {
      add_tangent_action(cell, law, geometry, u, moduli, x, components_of(corners));
      return 0;
    }

    SOFTCELL_HOST_DEVICE static Components<Real> components_of(Real *const corners)
    {
      constexpr int n = 8 * CellBricks<Real>::n_cells;
      return {{corners, corners + n, corners + 2 * n}};
    }
  };

  template <class Real, class Law>
  struct ResidualAction
  {
    static constexpr int n_values = 3, min_blocks = 0;
    static constexpr bool counts = true, shares_state = false;

    Law law;
    Components<const Real> u;

    SOFTCELL_HOST_DEVICE unsigned int operator()(const ThreadCell<Real, shares_state> &cell,
                                                 const CellGeometry<Real> &geometry,
                                                 Real *const corners) const
    {
      return add_residual(cell, law, geometry, u, TangentAction<Real, Law>::components_of(corners));
    }
  };

  template <class Real, class Law>
  struct ModuliAction
  {
    static constexpr int n_values = 0, min_blocks = 0;
    static constexpr bool counts = true, shares_state = false;

    Law law;
    Components<const Real> u;
    PointModuli<Real> moduli;

    SOFTCELL_HOST_DEVICE unsigned int operator()(const ThreadCell<Real, shares_state> &cell,
                                                 const CellGeometry<Real> &geometry,
                                                 Real * /*corners*/) const
    {
      return keep_moduli(cell, law, geometry, u, moduli);
    }
  };

  template <class Real, class Law>
  struct DiagonalAction
  {
    static constexpr int n_values = 6, min_blocks = 0;
    static constexpr bool counts = false, shares_state = false;

    Law law;
    Components<const Real> u;
    PointModuli<const Real> moduli;

    SOFTCELL_HOST_DEVICE unsigned int operator()(const ThreadCell<Real, shares_state> &cell,
                                                 const CellGeometry<Real> &geometry,
                                                 Real *const corners) const
    {
      constexpr int n = CellBricks<Real>::n_cells;
      for (int k = 0; k < 48; ++k)
        corners[k * n] = 0;
      const SharedRows<Real, 8> blocks{corners};
      add_corner_blocks(cell, law, geometry, u, moduli, blocks);
      return 0;
    }
  };
} // namespace softcell
