// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of a body with its supports in the free unknowns of a lattice.

#include <softcell/operators/lattice_tangent.h>

#include <algorithm>

namespace softcell
{
  namespace
  {
    /// Inverts a symmetric block by its cofactors; the entries are those of LatticeBlocks.
    void invert(double (&A)[6])
    {
      const double xx = A[1] * A[2] - A[3] * A[3], xy = A[4] * A[3] - A[5] * A[2],
                   xz = A[5] * A[3] - A[4] * A[1], yy = A[0] * A[2] - A[4] * A[4],
                   zz = A[0] * A[1] - A[5] * A[5], yz = A[4] * A[5] - A[0] * A[3];
      const double determinant = A[0] * xx + A[5] * xy + A[4] * xz;
      const double trace       = A[0] + A[1] + A[2];
      const bool is_positive   = A[0] > 0 && zz > 0 && determinant > 1e-6 * zz * trace;
      const double inverse[6]  = {xx, yy, zz, yz, xz, xy};
      for (unsigned int k = 0; k < 6; ++k)
        if (is_positive)
          A[k] = inverse[k] / determinant;
        else
          A[k] = k < 3 && trace > 0 ? 1 / trace : 0;
    }
  } // namespace

  template <class Real>
  LatticeTangent<Real>::LatticeTangent(const CellLattice &cells,
                                       const Material &material,
                                       const LatticeUnknowns &unknowns)
      : unknowns_(unknowns),
        cells_(cells),
        elasticity_(cells_, material),
        masses_(lumped<Real>(material.density(), cells))
  {
  }

  template <class Real>
  void LatticeTangent<Real>::product(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
    elasticity_.vmult(y, x);
    supports_.add_product(y, x);
    if (stiffness_ == 1 && mass_ == 0)
      return;
    const Real stiffness = stiffness_, mass = mass_, *const m = masses_.component(0);
    unknowns_.for_each_run([&](const std::size_t begin, const std::size_t end) {
      for (unsigned int c = 0; c < dim; ++c)
      {
        Real *const y_c       = y.component(c);
        const Real *const x_c = x.component(c);
#pragma omp simd
        for (std::size_t i = begin; i < end; ++i)
          y_c[i] = stiffness * y_c[i] + mass * m[i] * x_c[i];
      }
    });
  }

  template <class Real>
  void LatticeTangent<Real>::vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
    product(y, x);
    unknowns_.hold(y);
  }

  template <class Real>
  void LatticeTangent<Real>::inverse_diagonal(LatticeBlocks<Real> &blocks) const
  {
    elasticity_.diagonal(blocks);
    supports_.add_diagonal(blocks);
    unknowns_.for_each_run([&](const std::size_t begin, const std::size_t end) {
      for (std::size_t node = begin; node < end; ++node)
      {
        double A[6];
        for (unsigned int k = 0; k < 6; ++k)
          A[k] = stiffness_ * blocks.component(k)[node] +
                 (k < 3 ? mass_ * masses_.component(0)[node] : 0);
        const double largest  = std::max({A[0], A[1], A[2]});
        const bool is_free[3] = {unknowns_.is_free(node, 0), unknowns_.is_free(node, 1),
                                 unknowns_.is_free(node, 2)};
        const auto set        = [&](const bool held_as_well) {
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a; b < dim; ++b)
              if (!(is_free[a] && is_free[b]))
                A[a == b ? a : 6 - a - b] = a == b && held_as_well ? largest : 0;
        };
        set(true);
        invert(A);
        set(false);
        for (unsigned int k = 0; k < 6; ++k)
          blocks.component(k)[node] = A[k];
      }
    });
  }

  template <class Real>
  std::size_t LatticeTangent<Real>::memory() const
  {
    return cells_.memory() + elasticity_.memory() + supports_.memory() +
           masses_.entries().size() * sizeof(Real);
  }

  template class LatticeTangent<double>;
  template class LatticeTangent<float>;
} // namespace softcell
