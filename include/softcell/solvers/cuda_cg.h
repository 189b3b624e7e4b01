// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients that stay on a graphics card.
#pragma once

#include <softcell/base/device.h>

#include <functional>
#include <optional>
#include <vector>

namespace softcell
{
  /// Preconditioned conjugate gradients on a device: Cuda, or Serial, which runs the same kernels
  /// on the host.
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
    using Operator = std::function<void(Field &y, const Field &x)>;

    explicit CudaCG(std::size_t size);

    /// Solves A x = b from x = 0 and returns the iterations. At negative curvature, or an r.z that
    /// an indefinite M makes negative, it stops with the x so far, as LinearSolver does.
    /// @param M  near to the inverse of A.
    /// @param b  0 in unknowns that are not free, as all that A and M give.
    /// @param tolerance  of |b - A x| / |b|.
    /// @throws NotConverged, also where a number is no longer finite or r.z is not positive at once
    unsigned int solve(const Operator &A,
                       const Operator &M,
                       Field &x,
                       const Field &b,
                       double tolerance,
                       unsigned int max_iterations);

    /// The same, but returns nothing where the iterations do not suffice.
    /// @param goes_on  at negative curvature, for largest_eigenvalue().
    std::optional<unsigned int> iterate(const Operator &A,
                                        const Operator &M,
                                        Field &x,
                                        const Field &b,
                                        double tolerance,
                                        unsigned int max_iterations,
                                        bool goes_on = false);

    /// |b - A x| / |b| after each iteration.
    const std::vector<double> &history() const
    {
      return history_;
    }
    /// Of M A, as far as the iterations have seen; NaN without any.
    double largest_eigenvalue() const;

  private:
    template <class Terms>
    void sum_up(const Terms &terms, double *sum);

    Field r_, p_, z_;                        // the last one for A p as well
    DeviceArray<double, Device> block_sums_; // (blocks)
    DeviceArray<double, Device> scalars_;    // p.Ap, r.r
    DeviceArray<double, Device> rz_;         // r.z of each iteration
    std::vector<double> curvatures_;         // p.Ap of each
    std::vector<double> history_;
  };

  extern template class CudaCG<double, Cuda>;
  extern template class CudaCG<float, Cuda>;
  extern template class CudaCG<double, Serial>;
  extern template class CudaCG<float, Serial>;

  /// The inverse of a matrix' diagonal, the simplest preconditioner.
  template <class Real, class Device>
  class InverseDiagonal
  {
  public:
    using Field = DeviceArray<Real, Device>;

    /// @param diagonal  (size) or longer; 0 in unknowns that are not free, and there the inverse is
    /// 0.
    InverseDiagonal(const Field &diagonal, std::size_t size);

    void vmult(Field &y, const Field &x) const;

  private:
    Field inverse_;
  };
} // namespace softcell
