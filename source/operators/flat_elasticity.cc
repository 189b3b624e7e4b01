// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent without a matrix, on any discretization.

#include <softcell/operators/flat_elasticity.h>

#include "cell_kernels.h"
#include "inverted_points.h"
#include "simd_numbers.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace softcell
{
  namespace
  {
    template <class Real>
    using Packed = typename SimdNumbers<Real>::Number;

    /// I + du/dX, or du/dX alone, at the points of a batch.
    template <class Real>
    Matrix3<Packed<Real>> gradient(const typename FlatPatches<Real>::PointBatch &batch,
                                   const View<const Real> &u)
    {
      using Number             = Packed<Real>;
      constexpr unsigned int W = Number::size();
      Matrix3<Number> H{};
      for (unsigned int k = 0; k < batch.length; ++k)
      {
        const unsigned int *const nodes = batch.nodes + k * W;
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
        {
          const Number u_c([&](const auto lane) { return u[3 * nodes[lane] + c]; });
#pragma GCC unroll 3
          for (int A = 0; A < 3; ++A)
            H(c, A) += u_c * SimdNumbers<Real>::load(batch.gradients, 3 * k + A);
        }
      }
      return H;
    }

    template <class Real>
    Matrix3<Packed<Real>> load_matrix(const dealii::AlignedVector<Real> &matrices,
                                      const std::size_t batch)
    {
      Matrix3<Packed<Real>> result;
#pragma GCC unroll 9
      for (int k = 0; k < 9; ++k)
        result.entries[k] = SimdNumbers<Real>::load(matrices.data(), 9 * batch + k);
      return result;
    }

    template <class Real>
    void store_matrix(const Matrix3<Packed<Real>> &matrix,
                      dealii::AlignedVector<Real> &matrices,
                      const std::size_t batch)
    {
#pragma GCC unroll 9
      for (int k = 0; k < 9; ++k)
        SimdNumbers<Real>::store(matrix.entries[k], matrices.data(), 9 * batch + k);
    }

    /// The matrix of another batch in each lane.
    template <class Real>
    Matrix3<Packed<Real>> gather_matrix(const dealii::AlignedVector<Real> &matrices,
                                        const unsigned int *const points)
    {
      constexpr unsigned int W = SimdNumbers<Real>::W;
      Matrix3<Packed<Real>> result;
#pragma GCC unroll 9
      for (unsigned int k = 0; k < 9; ++k)
        result.entries[k] =
          Packed<Real>([&](const auto lane) { return matrices[points[lane] + k * W]; });
      return result;
    }

    /// The tangent at F, from the pressure that set_state() has kept.
    template <class Law, class Number>
    auto tangent_at(const Law &law, const Matrix3<Number> &F, const Number &pressure)
    {
      auto tangent   = law.linearisation(F, pressure);
      tangent.lambda = law.lambda;
      return tangent;
    }
  } // namespace

  template <class Real>
  FlatElasticity<Real>::FlatElasticity(const FlatPatches<Real> &patches,
                                       std::vector<Material> materials)
      : patches_(patches),
        materials_(std::move(materials)),
        F_(patches.n_point_batches() * 9 * SimdNumbers<Real>::W),
        stresses_(F_.size()),
        pressures_(F_.size() / 9)
  {
    const std::vector<Real> rest(3 * patches.n_nodes(), Real(0));
    set_state({rest.data(), rest.size()});
  }

  template <class Real>
  void FlatElasticity<Real>::set_state(const View<const Real> u)
  {
    using Simd              = SimdNumbers<Real>;
    unsigned int n_inverted = 0;
#pragma omp parallel for reduction(+ : n_inverted)
    for (std::size_t b = 0; b < patches_.n_point_batches(); ++b)
    {
      const auto batch = patches_.point_batch(b);
      auto F           = gradient<Real>(batch, u);
      for (int c = 0; c < 3; ++c)
        F(c, c) += Real(1);
      store_matrix<Real>(F, F_, b);
      materials_[batch.label].visit([&](const auto &double_law) {
        const auto law = rounded<Real>(double_law);
        n_inverted += Simd::count(!law.is_admissible(determinant(F)));
        Simd::store(pressure<Simd>(law, F), pressures_.data(), b);
      });
    }
    throw_if_inverted(n_inverted);
  }

  template <class Real>
  double FlatElasticity<Real>::energy() const
  {
    std::vector<double> energies(patches_.n_point_batches());
#pragma omp parallel for
    for (std::size_t b = 0; b < energies.size(); ++b)
    {
      const auto batch = patches_.point_batch(b);
      materials_[batch.label].visit([&](const auto &law) {
        energies[b] = reduce(SimdNumbers<Real>::load(batch.weights, 0) *
                             rounded<Real>(law).energy(load_matrix(F_, b)));
      });
    }
    return std::accumulate(energies.begin(), energies.end(), 0.);
  }

  template <class Real>
  double FlatElasticity<Real>::min_jacobian() const
  {
    double smallest = std::numeric_limits<double>::max();
    for (std::size_t b = 0; b < patches_.n_point_batches(); ++b)
    {
      Packed<Real> J = determinant(load_matrix(F_, b));
      where(SimdNumbers<Real>::load(patches_.point_batch(b).weights, 0) == 0, J) =
        std::numeric_limits<Real>::max();
      smallest = std::min<double>(smallest, hmin(J));
    }
    return smallest;
  }

  template <class Real>
  void FlatElasticity<Real>::residual(const View<Real> r)
  {
    using Simd = SimdNumbers<Real>;
#pragma omp parallel for
    for (std::size_t b = 0; b < patches_.n_point_batches(); ++b)
    {
      const auto batch = patches_.point_batch(b);
      materials_[batch.label].visit([&](const auto &double_law) {
        const auto law    = rounded<Real>(double_law);
        const auto weight = Simd::load(batch.weights, 0);
        store_matrix<Real>(
          weight * law.first_piola_stress(load_matrix(F_, b), Simd::load(pressures_.data(), b)),
          stresses_, b);
      });
    }
    integrate(r);
  }

  template <class Real>
  void FlatElasticity<Real>::vmult(const View<Real> y, const View<const Real> x)
  {
    using Simd = SimdNumbers<Real>;
#pragma omp parallel for
    for (std::size_t b = 0; b < patches_.n_point_batches(); ++b)
    {
      const auto batch = patches_.point_batch(b);
      const auto dF    = gradient<Real>(batch, x);
      materials_[batch.label].visit([&](const auto &double_law) {
        const auto tangent = tangent_at(rounded<Real>(double_law), load_matrix(F_, b),
                                        Simd::load(pressures_.data(), b));
        store_matrix<Real>(Simd::load(batch.weights, 0) * tangent(dF), stresses_, b);
      });
    }
    integrate(y);
  }

  template <class Real>
  void FlatElasticity<Real>::integrate(const View<Real> r) const
  {
    using Number             = Packed<Real>;
    constexpr unsigned int W = Number::size();
#pragma omp parallel for
    for (std::size_t b = 0; b < patches_.n_node_batches(); ++b)
    {
      const auto batch = patches_.node_batch(b);
      Number sums[3]   = {};
      for (unsigned int k = 0; k < batch.length; ++k)
      {
        const auto P = gather_matrix(stresses_, batch.points + k * W);
#pragma GCC unroll 3
        for (int A = 0; A < 3; ++A)
        {
          const Number g = SimdNumbers<Real>::load(batch.gradients, 3 * k + A);
#pragma GCC unroll 3
          for (int c = 0; c < 3; ++c)
            sums[c] += P(c, A) * g;
        }
      }
      const unsigned int n = std::min<std::size_t>(W, patches_.n_nodes() - b * W);
      for (unsigned int lane = 0; lane < n; ++lane)
        for (unsigned int c = 0; c < 3; ++c)
          r[3 * (b * W + lane) + c] = sums[c][lane];
    }
  }

  template <class Real>
  void FlatElasticity<Real>::diagonal(const View<Real> blocks) const
  {
    std::fill(blocks.begin(), blocks.end(), Real(0));
    constexpr unsigned int W = SimdNumbers<Real>::W;
#pragma omp parallel for
    for (std::size_t b = 0; b < patches_.n_node_batches(); ++b)
    {
      const auto batch     = patches_.node_batch(b);
      const unsigned int n = std::min<std::size_t>(W, patches_.n_nodes() - b * W);
      for (unsigned int lane = 0; lane < n; ++lane)
        for (unsigned int k = 0; k < batch.length; ++k)
        {
          const unsigned int point = batch.points[k * W + lane];
          const std::size_t from = point / (9 * W), entry = from * W + point % W;
          Matrix3<Real> F;
          for (unsigned int i = 0; i < 9; ++i)
            F.entries[i] = F_[point + i * W];
          NodalGradient<Real> dF;
          for (unsigned int A = 0; A < 3; ++A)
            dF.gradient[A] = batch.gradients[(3 * k + A) * W + lane];
          const auto points = patches_.point_batch(from);
          materials_[points.label].visit([&](const auto &law) {
            const auto tangent = tangent_at(rounded<Real>(law), F, pressures_[entry]);
            for (dF.component = 0; dF.component < 3; ++dF.component)
            {
              const Matrix3<Real> dP = tangent(dF);
              for (int a = 0; a < 3; ++a)
                blocks[(3 * (b * W + lane) + a) * 3 + dF.component] +=
                  points.weights[point % W] * dot(dP, a, dF.gradient);
            }
          });
        }
    }
  }

  template class FlatElasticity<double>;
  template class FlatElasticity<float>;
} // namespace softcell
