// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaCG for any device; what instantiates it includes this.
#pragma once

#include "entry_kernels.h"

#include <softcell/base/device_launch.h>
#include <softcell/base/exceptions.h>
#include <softcell/solvers/cuda_cg.h>
#include <softcell/solvers/lanczos.h>

#include <cmath>
#include <string>

namespace softcell
{
  template <class Real>
  struct ReciprocalAction
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
  struct ScaleAction
  {
    const Real *factors, *x;
    Real *y;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      y[i] = factors[i] * x[i];
    }
  };

  /// p = z + beta p, or 0 if r.z, with an M that is not positive, is not: then p.Ap tells the host.
  template <class Real>
  struct DirectionAction
  {
    const Real *z;
    Real *p;
    const double *rz; // now, and before it that of the last iteration
    bool is_first;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i) const
    {
      if (*rz <= 0)
        p[i] = 0;
      else
        p[i] = is_first ? z[i] : z[i] + Real(rz[0] / rz[-1]) * p[i];
    }
  };

  /// x = 0, r = b; r.r.
  template <class Real>
  struct StartTerms
  {
    const Real *b;
    Real *x, *r;

    SOFTCELL_HOST_DEVICE double operator()(const std::size_t i) const
    {
      const Real r_i = b[i];
      x[i]           = 0;
      r[i]           = r_i;
      return double(r_i) * r_i;
    }
  };

  /// a.b
  template <class Real>
  struct ProductTerms
  {
    const Real *a, *b;

    SOFTCELL_HOST_DEVICE double operator()(const std::size_t i) const
    {
      return double(a[i]) * b[i];
    }
  };

  /// x += alpha p, r -= alpha Ap; r.r.
  template <class Real>
  struct StepTerms
  {
    const Real *p, *Ap;
    Real *x, *r;
    const double *pAp, *rz;
    bool is_first, goes_on;

    SOFTCELL_HOST_DEVICE double operator()(const std::size_t i) const
    {
      const Real alpha = length(*pAp);
      const Real r_i   = r[i] - alpha * Ap[i];
      x[i] += alpha * p[i];
      r[i] = r_i;
      return double(r_i) * r_i;
    }

    /// At negative curvature 0, but in the first iteration as long as if it had the other sign.
    SOFTCELL_HOST_DEVICE double length(const double curvature) const
    {
      if (curvature > 0 || goes_on)
        return *rz / curvature;
      return is_first ? (curvature < 0 ? -*rz / curvature : 1) : 0;
    }
  };

  struct BlockTerms
  {
    const double *sums;

    SOFTCELL_HOST_DEVICE double operator()(const std::size_t i) const
    {
      return sums[i];
    }
  };

  template <class Real, class Device>
  InverseDiagonal<Real, Device>::InverseDiagonal(const Field &diagonal, const std::size_t size)
      : inverse_(size)
  {
    for_each_entry<Device>(ReciprocalAction<Real>{diagonal.data(), inverse_.data()}, size);
  }

  template <class Real, class Device>
  void InverseDiagonal<Real, Device>::vmult(Field &y, const Field &x) const
  {
    for_each_entry<Device>(ScaleAction<Real>{inverse_.data(), x.data(), y.data()}, inverse_.size());
  }

  constexpr int n_sum_blocks = 256;

  template <class Real, class Device>
  CudaCG<Real, Device>::CudaCG(const std::size_t size)
      : r_(size), p_(size), z_(size), block_sums_(n_sum_blocks), scalars_(2)
  {
  }

  template <class Real, class Device>
  template <class Terms>
  void CudaCG<Real, Device>::sum_up(const Terms &terms, double *const sum)
  {
    Device::launch(SumKernel<Terms>{terms, r_.size(), n_sum_blocks, block_sums_.data()},
                   n_sum_blocks);
    Device::launch(SumKernel<BlockTerms>{{block_sums_.data()}, n_sum_blocks, 1, sum}, 1);
  }

  template <class Device>
  std::vector<double> finite_numbers(const double *const from, const std::size_t n)
  {
    std::vector<double> numbers(n);
    Device::copy(numbers.data(), from, n * sizeof(double));
    for (const double number : numbers)
      if (!std::isfinite(number))
        throw NotConverged("conjugate gradients met a number that is not finite");
    return numbers;
  }

  template <class Real, class Device>
  std::optional<unsigned int> CudaCG<Real, Device>::iterate(const Operator &A,
                                                            const Operator &M,
                                                            Field &x,
                                                            const Field &b,
                                                            const double tolerance,
                                                            const unsigned int max_iterations,
                                                            const bool goes_on)
  {
    history_.clear();
    curvatures_.clear();
    if (rz_.size() < max_iterations)
      rz_ = DeviceArray<double, Device>(max_iterations);
    double *const pAp = scalars_.data(), *const rr = pAp + 1;
    sum_up(StartTerms<Real>{b.data(), x.data(), r_.data()}, rr);
    const double bb = finite_numbers<Device>(rr, 1)[0];
    if (bb == 0)
      return 0;
    for (unsigned int iteration = 1; iteration <= max_iterations; ++iteration)
    {
      const bool is_first = iteration == 1;
      double *const rz    = rz_.data() + iteration - 1;
      M(z_, r_);
      sum_up(ProductTerms<Real>{r_.data(), z_.data()}, rz);
      for_each_entry<Device>(DirectionAction<Real>{z_.data(), p_.data(), rz, is_first}, p_.size());
      A(z_, p_);
      sum_up(ProductTerms<Real>{p_.data(), z_.data()}, pAp);
      sum_up(StepTerms<Real>{p_.data(), z_.data(), x.data(), r_.data(), pAp, rz, is_first, goes_on},
             rr);
      const std::vector<double> scalars = finite_numbers<Device>(scalars_.data(), 2);
      if (scalars[0] <= 0 && !goes_on) // A is indefinite, or M
      {
        if (is_first && finite_numbers<Device>(rz, 1)[0] <= 0)
          throw NotConverged("conjugate gradients cannot start: the preconditioner is not "
                             "positive definite");
        return iteration;
      }
      curvatures_.push_back(scalars[0]);
      history_.push_back(std::sqrt(scalars[1] / bb));
      if (history_.back() <= tolerance)
        return iteration;
    }
    return {};
  }

  template <class Real, class Device>
  double CudaCG<Real, Device>::largest_eigenvalue() const
  {
    const std::size_t n          = curvatures_.size();
    const std::vector<double> rz = finite_numbers<Device>(rz_.data(), n);
    LanczosMatrix lanczos;
    for (std::size_t i = 0; i < n; ++i)
      lanczos.add(curvatures_[i] / rz[i], i == 0 ? 0 : rz[i] / rz[i - 1]);
    return lanczos.extreme_eigenvalues().second;
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
