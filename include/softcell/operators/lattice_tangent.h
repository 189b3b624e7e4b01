// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of a body with its supports, and its mass, in the free unknowns of a lattice.
#pragma once

#include <softcell/operators/lattice_matrix.h>
#include <softcell/operators/matrix_free_elasticity.h>

namespace softcell
{
  /// K = elasticity + supports, restricted to the free unknowns; or what a step in time makes of it
  /// and the lumped mass M: stiffness * K + mass * M.
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

    /// From now on K is stiffness * K + mass * M; 1 and 0 at first. Units: s^2 and 1 make it a
    /// mass.
    void combine(Real stiffness, Real mass)
    {
      stiffness_ = stiffness;
      mass_      = mass;
    }

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
    /// M, of each node. Units: kg
    const LatticeField<Real, 1> &masses() const
    {
      return masses_;
    }
    /// Units: byte
    std::size_t memory() const;

  private:
    const LatticeUnknowns &unknowns_;
    UniformCells<Real> cells_;
    MatrixFreeElasticity<Real> elasticity_;
    LatticeMatrix<Real> supports_;
    LatticeField<Real, 1> masses_;
    Real stiffness_ = 1, mass_ = 0;
  };
} // namespace softcell
