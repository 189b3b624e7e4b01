// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaCG for any device; what instantiates it includes this.
#pragma once

#include <softcell/base/device_launch.h>
#include <softcell/base/exceptions.h>
#include <softcell/mechanics/tensor.h>
#include <softcell/solvers/cuda_cg.h>

#include <cmath>
#include <string>
#include <utility>

namespace softcell
{
  /// Calls an action for every entry of a vector.
  template <class Action>
  struct EntryKernel
  {
    using Scratch = char;

    static constexpr int n_threads = 256, n_phases = 1, n_scratch = 0;

    Action action;
    std::size_t size;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const std::size_t i = std::size_t(block) * n_threads + thread;
      if (i < size)
        action(i);
    }
  };

  /// Sums over the entries of vectors, one in each block: terms(i, sums) adds what entry i has for
  /// Terms::n_sums sums.
  template <class Terms>
  struct SumKernel
  {
    using Scratch = double;

    static constexpr int n_threads = 256, n_phases = 9, n_sums = Terms::n_sums; // 2^(9-1) threads
    static constexpr int n_scratch = n_sums * n_threads;

    Terms terms;
    std::size_t size;
    int n_blocks;
    double *results; // (n_sums, n_blocks)

    SOFTCELL_HOST_DEVICE void
    operator()(const int phase, const int block, const int thread, double *const scratch) const
    {
      if (phase == 0)
      {
        double sums[n_sums] = {};
        for (std::size_t i = std::size_t(block) * n_threads + thread; i < size;
             i += std::size_t(n_blocks) * n_threads)
          terms(i, sums);
        for (int k = 0; k < n_sums; ++k)
          scratch[k * n_threads + thread] = sums[k];
        return;
      }
      const int half = n_threads >> phase;
      if (thread < half)
        for (int k = 0; k < n_sums; ++k)
        {
          scratch[k * n_threads + thread] += scratch[k * n_threads + thread + half];
          if (half == 1)
            results[k * n_blocks + block] = scratch[k * n_threads];
        }
    }
  };

  /// The sums of blocks.
  template <int n>
  struct BlockTerms
  {
    static constexpr int n_sums = n;

    const double *block_sums; // (n, n_blocks)
    int n_blocks;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      for (int k = 0; k < n; ++k)
        sums[k] += block_sums[k * n_blocks + i];
    }
  };

  template <class Real>
  struct InvertTerms
  {
    const Real *diagonal;
    Real *inverse;

    /// Positive even where an indefinite matrix has a negative entry.
    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      const Real d = diagonal[i];
      inverse[i]   = d == 0 ? Real(0) : 1 / (d < 0 ? -d : d);
    }
  };

  /// x = 0, r = b, p = z; r.r and r.z.
  template <class Real>
  struct StartTerms
  {
    static constexpr int n_sums = 2;

    const Real *inverse, *b;
    Real *x, *r, *p;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      const Real r_i = inverse[i] == 0 ? Real(0) : b[i], z_i = inverse[i] * r_i;
      x[i] = 0;
      r[i] = r_i;
      p[i] = z_i;
      sums[0] += double(r_i) * r_i;
      sums[1] += double(r_i) * z_i;
    }
  };

  /// p.Ap
  template <class Real>
  struct CurvatureTerms
  {
    static constexpr int n_sums = 1;

    const Real *p, *Ap;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      sums[0] += double(p[i]) * Ap[i];
    }
  };

  /// x += alpha p, r -= alpha Ap; r.r and r.z.
  template <class Real>
  struct StepTerms
  {
    static constexpr int n_sums = 2;

    const Real *inverse, *p, *Ap;
    Real *x, *r;
    const double *curvature, *rz;
    bool is_first;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      const Real alpha = step(*curvature, *rz);
      const Real r_i   = r[i] - alpha * Ap[i];
      x[i] += alpha * p[i];
      r[i] = r_i;
      sums[0] += double(r_i) * r_i;
      sums[1] += double(r_i) * inverse[i] * r_i;
    }

    /// At negative curvature 0, but in the first iteration as long as if it had the other sign.
    SOFTCELL_HOST_DEVICE double step(const double pAp, const double rz_now) const
    {
      if (pAp > 0)
        return rz_now / pAp;
      return is_first ? (pAp < 0 ? -rz_now / pAp : 1) : 0;
    }
  };

  /// p = z + beta p
  template <class Real>
  struct DirectionTerms
  {
    const Real *inverse, *r;
    Real *p;
    const double *rz, *rz_before;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      p[i] = inverse[i] * r[i] + Real(*rz / *rz_before) * p[i];
    }
  };

  constexpr int n_sum_blocks = 256;

  template <class Real, class Device>
  CudaCG<Real, Device>::CudaCG(const std::size_t size)
      : inverse_(size), r_(size), p_(size), Ap_(size), block_sums_(2 * n_sum_blocks), scalars_(6)
  {
  }

  template <class Device, class Action>
  void for_each_entry(const Action &action, const std::size_t size)
  {
    using Kernel = EntryKernel<Action>;
    Device::launch(Kernel{action, size}, (size + Kernel::n_threads - 1) / Kernel::n_threads);
  }

  template <class Real, class Device>
  void CudaCG<Real, Device>::set_diagonal(const Field &diagonal)
  {
    for_each_entry<Device>(InvertTerms<Real>{diagonal.data(), inverse_.data()}, inverse_.size());
  }

  template <class Real, class Device>
  template <class Terms>
  void CudaCG<Real, Device>::sum_up(const Terms &terms, double *const sums)
  {
    Device::launch(SumKernel<Terms>{terms, r_.size(), n_sum_blocks, block_sums_.data()},
                   n_sum_blocks);
    using Blocks = BlockTerms<Terms::n_sums>;
    Device::launch(SumKernel<Blocks>{{block_sums_.data(), n_sum_blocks}, n_sum_blocks, 1, sums}, 1);
  }

  template <class Real, class Device>
  unsigned int CudaCG<Real, Device>::solve(const Product &A,
                                           Field &x,
                                           const Field &b,
                                           const double tolerance,
                                           const unsigned int max_iterations)
  {
    history_.clear();
    double scalars[2]; // p.Ap, r.r
    const auto fetch = [&](const double *from) {
      Device::copy(scalars, from, sizeof(scalars));
      if (!std::isfinite(scalars[0]) || !std::isfinite(scalars[1]))
        throw NotConverged("conjugate gradients met a number that is not finite");
    };
    double *now = scalars_.data(), *before = now + 3;
    sum_up(StartTerms<Real>{inverse_.data(), b.data(), x.data(), r_.data(), p_.data()}, now + 1);
    fetch(now);
    const double bb = scalars[1];
    if (bb == 0)
      return 0;
    for (unsigned int iteration = 1; iteration <= max_iterations; ++iteration)
    {
      std::swap(now, before);
      A(Ap_, p_);
      sum_up(CurvatureTerms<Real>{p_.data(), Ap_.data()}, now);
      sum_up(StepTerms<Real>{inverse_.data(), p_.data(), Ap_.data(), x.data(), r_.data(), now,
                             before + 2, iteration == 1},
             now + 1);
      fetch(now);
      if (scalars[0] <= 0)
        return iteration;
      history_.push_back(std::sqrt(scalars[1] / bb));
      if (history_.back() <= tolerance)
        return iteration;
      for_each_entry<Device>(
        DirectionTerms<Real>{inverse_.data(), r_.data(), p_.data(), now + 2, before + 2},
        p_.size());
    }
    throw NotConverged("conjugate gradients reached a relative residual of " +
                       std::to_string(history_.back()) + " instead of " +
                       std::to_string(tolerance) + " in " + std::to_string(max_iterations) +
                       " iterations");
  }
} // namespace softcell
