// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients that stay on a graphics card.
#pragma once

#include <softcell/base/device.h>

#include <functional>
#include <vector>

namespace softcell
{
  /// Conjugate gradients with the inverted diagonal as preconditioner on a device: Cuda, or Serial,
  /// which runs the same kernels on the host.
  ///
  /// Vectors and step lengths stay on the device. The host gets two scalars in each iteration, p.Ap
  /// and r.r, and decides by them whether to go on. Products of vectors are sums of double
  /// precision in a fixed order: those of 256 blocks, then one block over these. So results are
  /// always the same. Source: Magnoux algorithm 2.
  template <class Real, class Device>
  class CudaCG
  {
  public:
    using Field = DeviceArray<Real, Device>;
    /// y = A x
    using Product = std::function<void(Field &y, const Field &x)>;

    explicit CudaCG(std::size_t size);

    /// @param diagonal  of A, (size) or longer; 0 in unknowns that are not free, which stay 0.
    void set_diagonal(const Field &diagonal);

    /// Solves A x = b from x = 0 and returns the iterations. At negative curvature it stops with
    /// the x so far, as LinearSolver does.
    /// @param tolerance  of |b - A x| / |b|, in the unknowns that are free.
    /// @throws NotConverged, also where a number is no longer finite
    unsigned int solve(const Product &A,
                       Field &x,
                       const Field &b,
                       double tolerance,
                       unsigned int max_iterations);

    /// |b - A x| / |b| after each iteration of the last solve().
    const std::vector<double> &history() const
    {
      return history_;
    }

  private:
    template <class Terms>
    void sum_up(const Terms &terms, double *sums);

    Field inverse_, r_, p_, Ap_;
    DeviceArray<double, Device> block_sums_; // (2, blocks)
    DeviceArray<double, Device> scalars_;    // (2, 3) p.Ap, r.r, r.z of even and odd iterations
    std::vector<double> history_;
  };
} // namespace softcell
