// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaCG for any device; what instantiates it includes this.
#pragma once

#include "entry_kernels.h"

#include <softcell/base/device_launch.h>
#include <softcell/base/exceptions.h>
#include <softcell/solvers/cuda_cg.h>

#include <cmath>
#include <string>
#include <utility>

namespace softcell
{
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

  template <class Real>
  struct ScaleTerms
  {
    const Real *factors, *x;
    Real *y;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      y[i] = factors[i] * x[i];
    }
  };

  /// x = 0, r = b; r.r.
  template <class Real>
  struct StartTerms
  {
    static constexpr int n_sums = 1;

    const Real *b;
    Real *x, *r;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      const Real r_i = b[i];
      x[i]           = 0;
      r[i]           = r_i;
      sums[0] += double(r_i) * r_i;
    }
  };

  /// a.b
  template <class Real>
  struct ProductTerms
  {
    static constexpr int n_sums = 1;

    const Real *a, *b;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      sums[0] += double(a[i]) * b[i];
    }
  };

  /// x += alpha p, r -= alpha Ap; r.r.
  template <class Real>
  struct StepTerms
  {
    static constexpr int n_sums = 1;

    const Real *p, *Ap;
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
    const Real *z;
    Real *p;
    const double *rz, *rz_before;
    bool is_first;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      p[i] = is_first ? z[i] : z[i] + Real(*rz / *rz_before) * p[i];
    }
  };

  template <class Real, class Device>
  InverseDiagonal<Real, Device>::InverseDiagonal(const Field &diagonal, const std::size_t size)
      : inverse_(size)
  {
    for_each_entry<Device>(InvertTerms<Real>{diagonal.data(), inverse_.data()}, size);
  }

  template <class Real, class Device>
  void InverseDiagonal<Real, Device>::vmult(Field &y, const Field &x) const
  {
    for_each_entry<Device>(ScaleTerms<Real>{inverse_.data(), x.data(), y.data()}, inverse_.size());
  }

  constexpr int n_sum_blocks = 256;

  template <class Real, class Device>
  CudaCG<Real, Device>::CudaCG(const std::size_t size)
      : r_(size), p_(size), z_(size), block_sums_(n_sum_blocks), scalars_(6)
  {
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
  std::optional<unsigned int> CudaCG<Real, Device>::iterate(const Operator &A,
                                                            const Operator &M,
                                                            Field &x,
                                                            const Field &b,
                                                            const double tolerance,
                                                            const unsigned int max_iterations)
  {
    history_.clear();
    lanczos_.clear();
    double scalars[3]; // p.Ap, r.r, r.z
    const auto fetch = [&](const double *from, const int begin, const int end) {
      Device::copy(scalars + begin, from + begin, (end - begin) * sizeof(double));
      for (int k = begin; k < end; ++k)
        if (!std::isfinite(scalars[k]))
          throw NotConverged("conjugate gradients met a number that is not finite");
    };
    double *now = scalars_.data(), *before = now + 3, rz_before = 0;
    sum_up(StartTerms<Real>{b.data(), x.data(), r_.data()}, now + 1);
    fetch(now, 1, 2);
    const double bb = scalars[1];
    if (bb == 0)
      return 0;
    for (unsigned int iteration = 1; iteration <= max_iterations; ++iteration)
    {
      const bool is_first = iteration == 1;
      std::swap(now, before);
      M(z_, r_);
      sum_up(ProductTerms<Real>{r_.data(), z_.data()}, now + 2);
      for_each_entry<Device>(
        DirectionTerms<Real>{z_.data(), p_.data(), now + 2, before + 2, is_first}, p_.size());
      A(z_, p_);
      sum_up(ProductTerms<Real>{p_.data(), z_.data()}, now);
      sum_up(StepTerms<Real>{p_.data(), z_.data(), x.data(), r_.data(), now, now + 2, is_first},
             now + 1);
      fetch(now, 0, 3);
      const auto [curvature, rr, rz] = scalars;
      if (curvature <= 0) // A is indefinite
      {
        lanczos_.clear();
        return iteration;
      }
      lanczos_.add(curvature / rz, is_first ? 0 : rz / rz_before);
      rz_before = rz;
      history_.push_back(std::sqrt(rr / bb));
      if (history_.back() <= tolerance)
        return iteration;
    }
    return {};
  }

  template <class Real, class Device>
  unsigned int CudaCG<Real, Device>::solve(const Operator &A,
                                           const Operator &M,
                                           Field &x,
                                           const Field &b,
                                           const double tolerance,
                                           const unsigned int max_iterations)
  {
    if (const auto iterations = iterate(A, M, x, b, tolerance, max_iterations))
      return *iterations;
    throw NotConverged("conjugate gradients reached a relative residual of " +
                       std::to_string(history_.back()) + " instead of " +
                       std::to_string(tolerance) + " in " + std::to_string(max_iterations) +
                       " iterations");
  }
} // namespace softcell
