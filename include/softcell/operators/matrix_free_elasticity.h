// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent without a matrix.
#pragma once

#include <softcell/mechanics/material.h>
#include <softcell/operators/tangent.h>
#include <softcell/operators/uniform_cells.h>

namespace softcell
{
  /// What Elasticity does, on the cells of a uniform grid, by SIMD packs of cells and threads.
  ///
  /// Nodes without cells get 0. Imposed displacements are the caller's: he sets what belongs to
  /// their nodes to 0 in x and y. Under different numbers of threads all results are the same to
  /// the last digit.
  template <class Real>
  class MatrixFreeElasticity
  {
  public:
    /// @param cells  must outlive the object.
    MatrixFreeElasticity(const UniformCells<Real> &cells, const Material &material);

    /// Units: J. @throws InvertedPoint
    double energy(const LatticeVector<Real> &u) const;

    /// r = the internal force. Units: N. @throws InvertedPoint
    void residual(const LatticeVector<Real> &u, LatticeVector<Real> &r) const;

    /// Smallest det F over all integration points.
    double min_jacobian(const LatticeVector<Real> &u) const;

    /// Takes the displacement at which the tangent is formed; before, it is that at u = 0.
    /// @throws InvertedPoint
    void set_state(const LatticeVector<Real> &u, Tangent tangent = Tangent::exact);

    /// Takes another tangent at the same displacement.
    void set_tangent(Tangent tangent);

    /// y = K x, with the tangent K = d residual / du. Units: N/m
    void vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const;

    /// The diagonal blocks of the tangent. Units: N/m
    void diagonal(LatticeBlocks<Real> &blocks) const;

    const UniformCells<Real> &cells() const
    {
      return cells_;
    }
    /// Of what the operator keeps, without the cells. Units: byte
    std::size_t memory() const;

  private:
    const UniformCells<Real> &cells_;
    Material material_;
    LatticeVector<Real> u_;
    dealii::AlignedVector<Real> pressures_, // (packs of points, W) lambda v, where v is costly
      added_moduli_;                        // the same, to lambda, of a definite tangent
  };
} // namespace softcell
