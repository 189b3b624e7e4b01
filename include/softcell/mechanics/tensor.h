// SPDX-License-Identifier: LGPL-2.1-or-later
// A 3 x 3 matrix of any number type (double, float, a SIMD pack, an automatic-differentiation
// type), for host and device. deal.II's Tensor needs number traits that SIMD packs do not have.
#pragma once

#include <type_traits>

#ifdef __CUDACC__
#  define SOFTCELL_HOST_DEVICE __host__ __device__
#else
#  define SOFTCELL_HOST_DEVICE
#endif

namespace softcell
{
  /// Aggregate of nine numbers, row by row.
  template <class Number>
  struct Matrix3
  {
    Number entries[9];

    SOFTCELL_HOST_DEVICE Number &operator()(const int i, const int j)
    {
      return entries[3 * i + j];
    }
    SOFTCELL_HOST_DEVICE const Number &operator()(const int i, const int j) const
    {
      return entries[3 * i + j];
    }
  };

  /// What A and B combine to: the one to which the other converts (double and a pack of doubles:
  /// the pack).
  template <class A, class B>
  using Wider = std::conditional_t<std::is_convertible_v<A, B>, B, A>;

  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> identity()
  {
    const Number one(1), zero(0);
    return {{one, zero, zero, zero, one, zero, zero, zero, one}};
  }

  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> transpose(const Matrix3<Number> &A)
  {
    return {{A(0, 0), A(1, 0), A(2, 0), A(0, 1), A(1, 1), A(2, 1), A(0, 2), A(1, 2), A(2, 2)}};
  }

  template <class A, class B>
  SOFTCELL_HOST_DEVICE Matrix3<Wider<A, B>> operator+(const Matrix3<A> &a, const Matrix3<B> &b)
  {
    Matrix3<Wider<A, B>> sum;
    for (int k = 0; k < 9; ++k)
      sum.entries[k] = a.entries[k] + b.entries[k];
    return sum;
  }

  template <class A, class B>
  SOFTCELL_HOST_DEVICE Matrix3<Wider<A, B>> operator-(const Matrix3<A> &a, const Matrix3<B> &b)
  {
    Matrix3<Wider<A, B>> difference;
    for (int k = 0; k < 9; ++k)
      difference.entries[k] = a.entries[k] - b.entries[k];
    return difference;
  }

  template <class A, class B>
  SOFTCELL_HOST_DEVICE Matrix3<Wider<A, B>> operator*(const A &a, const Matrix3<B> &b)
  {
    Matrix3<Wider<A, B>> product;
    for (int k = 0; k < 9; ++k)
      product.entries[k] = a * b.entries[k];
    return product;
  }

  template <class A, class B>
  SOFTCELL_HOST_DEVICE Matrix3<Wider<A, B>> operator*(const Matrix3<A> &a, const Matrix3<B> &b)
  {
    Matrix3<Wider<A, B>> product;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        product(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return product;
  }

  template <class Number>
  SOFTCELL_HOST_DEVICE Number trace(const Matrix3<Number> &A)
  {
    return A(0, 0) + A(1, 1) + A(2, 2);
  }

  /// A : B = sum_ij A_ij B_ij.
  template <class A, class B>
  SOFTCELL_HOST_DEVICE Wider<A, B> double_contraction(const Matrix3<A> &a, const Matrix3<B> &b)
  {
    Wider<A, B> sum = a.entries[0] * b.entries[0];
    for (int k = 1; k < 9; ++k)
      sum += a.entries[k] * b.entries[k];
    return sum;
  }

  /// Row i of A times the vector v.
  template <class A, class B>
  SOFTCELL_HOST_DEVICE Wider<A, B> dot(const Matrix3<A> &a, const int i, const B *v)
  {
    return a(i, 0) * v[0] + a(i, 1) * v[1] + a(i, 2) * v[2];
  }

  template <class Number>
  SOFTCELL_HOST_DEVICE Number determinant(const Matrix3<Number> &A)
  {
    return A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1)) -
           A(0, 1) * (A(1, 0) * A(2, 2) - A(1, 2) * A(2, 0)) +
           A(0, 2) * (A(1, 0) * A(2, 1) - A(1, 1) * A(2, 0));
  }

  /// The matrix of cofactors, d det A / dA; its rows are the cross products of two rows of A.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> cofactor(const Matrix3<Number> &A)
  {
    Matrix3<Number> G;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        G(i, j) = A(i1, j1) * A(i2, j2) - A(i1, j2) * A(i2, j1);
      }
    return G;
  }

  /// The change of cofactor(A) with A.
  template <class A, class B>
  SOFTCELL_HOST_DEVICE Matrix3<Wider<A, B>> cofactor_change(const Matrix3<A> &a,
                                                            const Matrix3<B> &da)
  {
    Matrix3<Wider<A, B>> dG;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        dG(i, j) = a(i1, j1) * da(i2, j2) + a(i2, j2) * da(i1, j1) - a(i1, j2) * da(i2, j1) -
                   a(i2, j1) * da(i1, j2);
      }
    return dG;
  }

  /// The inverse of a matrix whose determinant is not 0.
  template <class Number>
  SOFTCELL_HOST_DEVICE Matrix3<Number> inverse(const Matrix3<Number> &A)
  {
    Matrix3<Number> B = transpose(cofactor(A));
    const Number s    = Number(1) / (A(0, 0) * B(0, 0) + A(0, 1) * B(1, 0) + A(0, 2) * B(2, 0));
    for (Number &b : B.entries)
      b = s * b;
    return B;
  }
} // namespace softcell
