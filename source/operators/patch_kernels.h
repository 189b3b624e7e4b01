// SPDX-License-Identifier: LGPL-2.1-or-later
// The integrals over one patch, vectorised over its nodes.
#pragma once

#include <softcell/discretization/patch.h>
#include <softcell/mechanics/kinematics.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>
#include <experimental/simd>

namespace softcell
{
  namespace stdx = std::experimental;
  using Pack     = stdx::native_simd<double>;

  constexpr unsigned int width = Pack::size();
  static_assert(width % 2 == 0, "Rows of the tangent are integrated in pairs.");

  /// Numbers that packs are loaded from and stored to at multiples of the width.
  using PackedArray = dealii::AlignedVector<double>;

  inline Pack load(const double *const packed)
  {
    return Pack(packed, stdx::vector_aligned);
  }

  /// A patch with the displacement of its nodes. Packs of nodes are filled up with nodes that have
  /// no shape.
  class DeformedPatch
  {
  public:
    void reinit(const Patch &patch, const Vector &u)
    {
      patch_    = patch;
      n_padded_ = (patch.n_nodes() + width - 1) / width * width;
      u_.resize_fast(3 * n_padded_);
      u_.fill(0.);
      for (unsigned int i = 0; i < patch.n_nodes(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          u_[c * n_padded_ + i] = u.begin()[3 * patch.nodes[i] + c];
    }

    const Patch &patch() const
    {
      return patch_;
    }
    /// Number of nodes, rounded up to full packs.
    unsigned int n_padded() const
    {
      return n_padded_;
    }

    /// Derivatives along `axis` at a point of the pack of nodes that begins with node j.
    Pack gradient(const unsigned int point, const unsigned int axis, const unsigned int j) const
    {
      const unsigned int n     = patch_.n_nodes();
      const double *first      = patch_.shapes->gradient(point) + axis * n + j;
      const unsigned int count = n - j;
      if (count >= width)
        return Pack(first, stdx::element_aligned);
      return Pack([&](const unsigned int i) { return i < count ? first[i] : 0.; });
    }

    Matrix3<double> deformation_gradient(const unsigned int point) const
    {
      Matrix3<Pack> products{};
      for (unsigned int j = 0; j < n_padded_; j += width)
#pragma GCC unroll 3
        for (unsigned int A = 0; A < 3; ++A)
        {
          const Pack g = gradient(point, A, j);
#pragma GCC unroll 3
          for (unsigned int c = 0; c < 3; ++c)
            products(c, A) += load(&u_[c * n_padded_ + j]) * g;
        }
      Matrix3<double> F;
#pragma GCC unroll 9
      for (unsigned int k = 0; k < 9; ++k)
        F.entries[k] = stdx::reduce(products.entries[k]) + (k % 4 == 0 ? 1. : 0.);
      return F;
    }

  private:
    Patch patch_;
    unsigned int n_padded_ = 0;
    PackedArray u_; // (3, n_padded)
  };

  /// int P : dN_i/dX over a patch.
  class PatchResidual
  {
  public:
    void reinit(const DeformedPatch &deformed)
    {
      n_padded_ = deformed.n_padded();
      r_.resize_fast(3 * n_padded_);
      r_.fill(0.);
    }

    template <class Law>
    void add(const Law &law,
             const DeformedPatch &deformed,
             const unsigned int point,
             const Matrix3<double> &F)
    {
      const Matrix3<double> P = deformed.patch().weights[point] * law.first_piola_stress(F);
      for (unsigned int i = 0; i < n_padded_; i += width)
      {
        const Pack g[3] = {deformed.gradient(point, 0, i), deformed.gradient(point, 1, i),
                           deformed.gradient(point, 2, i)};
#pragma GCC unroll 3
        for (unsigned int a = 0; a < 3; ++a)
        {
          double *const r = &r_[a * n_padded_ + i];
          (load(r) + dot(P, a, g)).copy_to(r, stdx::vector_aligned);
        }
      }
    }

    void scatter(const View<const unsigned int> nodes, Vector &r) const
    {
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int a = 0; a < 3; ++a)
          r.begin()[3 * nodes[i] + a] += r_[a * n_padded_ + i];
    }

    /// (3, n_padded), 0 for nodes that only fill up.
    const PackedArray &values() const
    {
      return r_;
    }

  private:
    unsigned int n_padded_ = 0;
    PackedArray r_;
  };

  /// int dN_i/dX . dP(e_b (x) dN_j/dX) over a patch.
  ///
  /// Points are gathered in batches. For each one the changes of stress dP under all nodal
  /// displacements are computed, a pack of nodes j at a time; then a small matrix product with the
  /// gradients of the nodes i adds the batch to the matrix. The tangent is symmetric, so only its
  /// blocks a <= b are integrated.
  class PatchTangent
  {
  public:
    void reinit(const DeformedPatch &deformed)
    {
      n_points_ = 0;
      n_        = deformed.patch().n_nodes();
      n_padded_ = deformed.n_padded();
      values_.resize_fast(9 * n_padded_ * n_padded_);
      values_.fill(0.);
      gradients_.resize_fast(batch * 3 * n_padded_);
      stresses_.resize_fast(batch * 18 * n_padded_);
    }

    template <class Law>
    void add(const Law &law,
             const DeformedPatch &deformed,
             const unsigned int point,
             const Matrix3<double> &F)
    {
      const auto tangent  = law.linearisation(F);
      const double weight = deformed.patch().weights[point];
      for (unsigned int j = 0; j < n_padded_; j += width)
      {
        NodalGradient<Pack> dF;
#pragma GCC unroll 3
        for (unsigned int A = 0; A < 3; ++A)
        {
          dF.gradient[A] = deformed.gradient(point, A, j);
          (weight * dF.gradient[A])
            .copy_to(&gradients_[(n_points_ * 3 + A) * n_padded_ + j], stdx::vector_aligned);
        }
        double *stress = &stresses_[(j * batch + n_points_ * width) * 18];
#pragma GCC unroll 3
        for (dF.component = 0; dF.component < 3; ++dF.component)
        {
          const Matrix3<Pack> dP = tangent(dF);
#pragma GCC unroll 3
          for (int a = 0; a <= dF.component; ++a)
#pragma GCC unroll 3
            for (int A = 0; A < 3; ++A, stress += width)
              dP(a, A).copy_to(stress, stdx::vector_aligned);
        }
      }
      if (++n_points_ == batch)
        contract();
    }

    /// Adds factor r r^T.
    void add_product(const double factor, const PackedArray &r)
    {
      for (unsigned int b = 0; b < 3; ++b)
        for (unsigned int a = 0; a <= b; ++a)
          for (unsigned int i = 0; i < n_; ++i)
          {
            const double r_i     = factor * r[a * n_padded_ + i];
            double *const values = row(a, i, b);
            for (unsigned int j = 0; j < n_padded_; j += width)
              (load(values + j) + r_i * load(&r[b * n_padded_ + j]))
                .copy_to(values + j, stdx::vector_aligned);
          }
    }

    /// (3, n, 3, n): row component, row node, column component, column node. It ends the
    /// integration.
    const double *values()
    {
      contract();
      for (unsigned int b = 0; b < 3; ++b)
        for (unsigned int a = 0; a < b; ++a)
          for (unsigned int i = 0; i < n_; ++i)
            for (unsigned int j = 0; j < n_; ++j)
              row(b, i, a)[j] = row(a, j, b)[i];
      if (n_ != n_padded_)
      {
        double *value = values_.data();
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int i = 0; i < n_; ++i)
            for (unsigned int b = 0; b < 3; ++b)
              value = std::copy_n(row(a, i, b), n_, value);
      }
      return values_.data();
    }

  private:
    static constexpr unsigned int batch = 8;

    /// The couplings of component a of node i with component b of all nodes.
    double *row(const unsigned int a, const unsigned int i, const unsigned int b)
    {
      return &values_[((a * n_padded_ + i) * 3 + b) * n_padded_];
    }

    /// Adds the batch to the blocks a <= b and empties it.
    void contract()
    {
      for (unsigned int j = 0; j < n_padded_; j += width)
        for (unsigned int i = 0; i < n_; i += 2)
        {
          Pack sums[2][6] = {}; // two rows, six blocks: what fits into the registers
          for (unsigned int point = 0; point < n_points_; ++point)
          {
            const double *const g      = &gradients_[point * 3 * n_padded_ + i];
            const double *const stress = &stresses_[(j * batch + point * width) * 18];
#pragma GCC unroll 3
            for (unsigned int A = 0; A < 3; ++A)
#pragma GCC unroll 6
              for (unsigned int k = 0; k < 6; ++k)
              {
                const Pack dP = load(stress + (k * 3 + A) * width);
                sums[0][k] += g[A * n_padded_] * dP;
                sums[1][k] += g[A * n_padded_ + 1] * dP;
              }
          }
#pragma GCC unroll 2
          for (unsigned int r = 0; r < 2; ++r)
#pragma GCC unroll 3
            for (unsigned int b = 0; b < 3; ++b)
#pragma GCC unroll 3
              for (unsigned int a = 0; a <= b; ++a)
              {
                double *const values = row(a, i + r, b) + j;
                (load(values) + sums[r][b * (b + 1) / 2 + a]).copy_to(values, stdx::vector_aligned);
              }
        }
      n_points_ = 0;
    }

    unsigned int n_ = 0, n_padded_ = 0;
    unsigned int n_points_ = 0; // in the batch
    PackedArray gradients_;     // (batch, 3, n_padded) times weight
    PackedArray stresses_;      // (n_padded / width, batch, 6 blocks, 3, width)
    PackedArray values_;        // (3, n_padded, 3, n_padded), for a <= b only until the end
  };
} // namespace softcell
