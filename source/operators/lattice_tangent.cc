// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of a body with its supports in the free unknowns of a lattice.

#include <softcell/operators/lattice_tangent.h>

#include "diagonal_block.h"

namespace softcell
{
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
        invert_free(A, [&](const int c) { return unknowns_.is_free(node, c); });
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
