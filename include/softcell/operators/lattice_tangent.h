// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of a body with its supports in the free unknowns of a lattice.
#pragma once

#include <softcell/operators/lattice_matrix.h>
#include <softcell/operators/matrix_free_elasticity.h>

namespace softcell
{
  /// K = elasticity + supports, restricted to the free unknowns.
  template <class Real>
  class LatticeTangent
  {
  public:
    /// @param unknowns  must outlive the object.
    LatticeTangent(const CellLattice &cells,
                   const Material &material,
                   const LatticeUnknowns &unknowns);

    /// y = K x, for an x that is 0 in unknowns that are not free. Units: N/m
    void vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const;

    /// y = K x in all unknowns. Units: N/m
    void product(LatticeVector<Real> &y, const LatticeVector<Real> &x) const;

    /// The diagonal blocks inverted, 0 in rows and columns of unknowns that are not free. A block
    /// that is not positive definite is replaced by its trace. Units: m/N
    void inverse_diagonal(LatticeBlocks<Real> &blocks) const;

    MatrixFreeElasticity<Real> &elasticity()
    {
      return elasticity_;
    }
    const MatrixFreeElasticity<Real> &elasticity() const
    {
      return elasticity_;
    }
    LatticeMatrix<Real> &supports()
    {
      return supports_;
    }
    const LatticeUnknowns &unknowns() const
    {
      return unknowns_;
    }
    /// Units: byte
    std::size_t memory() const;

  private:
    const LatticeUnknowns &unknowns_;
    UniformCells<Real> cells_;
    MatrixFreeElasticity<Real> elasticity_;
    LatticeMatrix<Real> supports_;
  };
} // namespace softcell
