// SPDX-License-Identifier: LGPL-2.1-or-later
// What a V-cycle does at nodes, for host and device.
#pragma once

#include "../operators/diagonal_block.h"
#include "../operators/node_kernels.h"

namespace softcell
{
  /// The nodes of a grid, and what its smoother has there.
  template <class Real>
  struct SmootherNodes
  {
    int n_nodes[3];
    int row, plane; // see NodeLattice
    std::size_t n_entries;
    const unsigned char *held; // (n_entries)
    const Real *D_inverse;     // (6, n_entries) see LatticeBlocks
    Real *x, *d;               // (3, n_entries)
    Real *r;

    /// s = b D^-1 r
    SOFTCELL_HOST_DEVICE void precondition(const std::size_t entry,
                                           const Real b,
                                           const Real *const r_now,
                                           Real *const s) const
    {
      const std::size_t n = n_entries;
      const Real *const D = D_inverse + entry;
      const Real x_i = b * r_now[0], y_i = b * r_now[1], z_i = b * r_now[2];
      s[0] = D[0] * x_i + D[5 * n] * y_i + D[4 * n] * z_i;
      s[1] = D[5 * n] * x_i + D[n] * y_i + D[3 * n] * z_i;
      s[2] = D[4 * n] * x_i + D[3 * n] * y_i + D[2 * n] * z_i;
    }

    /// x = 0, r as given, d = b D^-1 r
    SOFTCELL_HOST_DEVICE void
    start(const std::size_t entry, const Real b, const Real *const r_now) const
    {
      Real s[3];
      precondition(entry, b, r_now, s);
      for (int c = 0; c < 3; ++c)
      {
        x[c * n_entries + entry] = 0;
        r[c * n_entries + entry] = r_now[c];
        d[c * n_entries + entry] = s[c];
      }
    }

    /// Place of an entry; false if it belongs to no node.
    SOFTCELL_HOST_DEVICE bool locate(const std::size_t entry, int (&place)[3]) const
    {
      place[0] = int(entry) % plane % row;
      place[1] = int(entry) % plane / row;
      place[2] = int(entry) / plane;
      return place[0] < n_nodes[0] && place[1] < n_nodes[1] && place[2] < n_nodes[2];
    }
  };

  /// x += d, r -= K d, and the next d = a d + b D^-1 r. For NodeKernel.
  template <class Real>
  struct SmoothAction
  {
    static constexpr int n_values = 3;

    SmootherNodes<Real> nodes;
    Real a, b;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry, const Real *const Kd) const
    {
      // all is loaded before anything is stored: on small grids time is latency
      Real x[3], r[3], d[3], s[3];
      SOFTCELL_DEVICE_UNROLL
      for (int c = 0; c < 3; ++c)
      {
        const std::size_t i = c * nodes.n_entries + entry;
        x[c]                = nodes.x[i];
        r[c]                = nodes.r[i];
        d[c]                = nodes.d[i];
      }
      SOFTCELL_DEVICE_UNROLL
      for (int c = 0; c < 3; ++c)
        r[c] -= is_free(nodes.held, entry, c) ? Kd[c] : Real(0);
      nodes.precondition(entry, b, r, s);
      SOFTCELL_DEVICE_UNROLL
      for (int c = 0; c < 3; ++c)
      {
        const std::size_t i = c * nodes.n_entries + entry;
        nodes.x[i]          = x[c] + d[c];
        nodes.r[i]          = r[c];
        nodes.d[i]          = a * d[c] + s[c];
      }
    }
  };

  /// z = D^-1 r. This and what follows is called for every entry of a component.
  template <class Real>
  struct PreconditionAction
  {
    SmootherNodes<Real> nodes; // with z as d

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry) const
    {
      const std::size_t n = nodes.n_entries;
      const Real r[3]     = {nodes.r[entry], nodes.r[n + entry], nodes.r[2 * n + entry]};
      Real z[3];
      nodes.precondition(entry, 1, r, z);
      for (int c = 0; c < 3; ++c)
        nodes.d[c * n + entry] = z[c];
    }
  };

  /// Starts with a given residual.
  template <class Real, class Number>
  struct StartAction
  {
    SmootherNodes<Real> nodes;
    const Number *from;
    Real b;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry) const
    {
      Real r[3];
      for (int c = 0; c < 3; ++c)
        r[c] = Real(from[c * nodes.n_entries + entry]);
      nodes.start(entry, b, r);
    }
  };

  /// Starts with the sums of a finer grid's residual.
  template <class Real>
  struct RestrictAction
  {
    SmootherNodes<Real> nodes, fine;
    Real b;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry) const
    {
      int place[3];
      if (!nodes.locate(entry, place) || nodes.held[entry] == 7)
        return;
      Real sums[3] = {};
      for (int v = 0; v < 27; ++v)
      {
        const int step[3] = {v % 3 - 1, v / 3 % 3 - 1, v / 9 - 1};
        int child[3];
        bool is_inside = true;
        for (int d = 0; d < 3; ++d)
        {
          child[d] = 2 * place[d] + step[d];
          is_inside &= child[d] >= 0 && child[d] < fine.n_nodes[d];
        }
        if (!is_inside)
          continue;
        const Real value =
          Real(1) / (1 << (step[0] * step[0] + step[1] * step[1] + step[2] * step[2]));
        const std::size_t from = child[0] + fine.row * child[1] + fine.plane * child[2];
        for (int c = 0; c < 3; ++c)
          sums[c] += value * fine.r[c * fine.n_entries + from];
      }
      for (int c = 0; c < 3; ++c)
        if (!is_free(nodes.held, entry, c))
          sums[c] = 0;
      nodes.start(entry, b, sums);
    }
  };

  /// d = the trilinear function of a coarser grid's x.
  template <class Real>
  struct InterpolateAction
  {
    SmootherNodes<Real> nodes, coarse;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry) const
    {
      int place[3];
      if (!nodes.locate(entry, place) || nodes.held[entry] == 7)
        return;
      Real sums[3] = {};
      for (int v = 0; v < 8; ++v)
      {
        const int i = (place[0] + v % 2) / 2, j = (place[1] + v / 2 % 2) / 2,
                  k            = (place[2] + v / 4) / 2;
        const std::size_t from = i + coarse.row * j + coarse.plane * k;
        for (int c = 0; c < 3; ++c)
          sums[c] += coarse.x[c * coarse.n_entries + from];
      }
      for (int c = 0; c < 3; ++c)
        nodes.d[c * nodes.n_entries + entry] =
          is_free(nodes.held, entry, c) ? sums[c] / 8 : Real(0);
    }
  };

  /// x += d
  template <class Real>
  struct AddAction
  {
    const Real *d;
    Real *x;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      x[i] += d[i];
    }
  };

  /// Inverts diagonal blocks.
  template <class Real>
  struct InvertAction
  {
    std::size_t n_entries;
    const unsigned char *held;
    Real *blocks;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t entry) const
    {
      double A[6];
      for (int k = 0; k < 6; ++k)
        A[k] = blocks[k * n_entries + entry];
      invert_free(A, [&](const int c) { return is_free(held, entry, c); });
      for (int k = 0; k < 6; ++k)
        blocks[k * n_entries + entry] = Real(A[k]);
    }
  };

  /// y = x in another precision.
  template <class Number, class Real>
  struct ConvertAction
  {
    const Real *x;
    Number *y;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      y[i] = Number(x[i]);
    }
  };

  /// x = A^-1 r in some unknowns, a block of threads for each.
  template <class Real>
  struct CoarsestKernel
  {
    using Scratch = double;

    static constexpr int n_threads = 64, n_phases = 2, n_scratch = n_threads;

    int n;
    const int *entries;    // (n)
    const double *inverse; // (n, n)
    const Real *r;
    Real *x;

    SOFTCELL_HOST_DEVICE void
    operator()(const int phase, const int block, const int thread, double *const scratch) const
    {
      double sum = 0;
      if (phase == 0)
      {
        for (int j = thread; j < n; j += n_threads)
          sum += inverse[block * n + j] * r[entries[j]];
        scratch[thread] = sum;
      }
      else if (thread == 0)
      {
        for (int i = 0; i < n_threads; ++i)
          sum += scratch[i];
        x[entries[block]] = Real(sum);
      }
    }
  };
} // namespace softcell
