// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent without a matrix, on any discretization.
#pragma once

#include <softcell/mechanics/material.h>
#include <softcell/operators/flat_patches.h>

#include <vector>

namespace softcell
{
  /// What Elasticity does, on FlatPatches, by packs of points and packs of nodes and by threads
  /// (OMP_NUM_THREADS of them).
  ///
  /// Unknown 3 * node + c is component c, as in Vector; all results are for one rank. With F and
  /// the pressure kept at each point, a tangent action is one pass over the points, which leaves
  /// their stresses, and one over the nodes, which sums them up: no two threads write to the same
  /// place, and results are the same for any number of threads.
  template <class Real>
  class FlatElasticity
  {
  public:
    /// @param patches    with packs of the host; must outlive the object. After a change of rows
    ///                   call set_state().
    /// @param materials  one per label.
    FlatElasticity(const FlatPatches<Real> &patches, std::vector<Material> materials);

    /// Takes the displacement at which everything else is formed.
    /// @param u  (3 n_nodes) Units: m
    /// @throws InvertedPoint
    void set_state(View<const Real> u);

    /// Units: J.
    double energy() const;

    /// Smallest det F over all integration points.
    double min_jacobian() const;

    /// r = the internal force. Units: N.
    void residual(View<Real> r);

    /// y = K x, with the tangent K = d residual / du. Units: N/m
    void vmult(View<Real> y, View<const Real> x);

    /// The diagonal blocks of the tangent, (n_nodes, 3, 3). Units: N/m
    void diagonal(View<Real> blocks) const;

  private:
    /// Sums the stresses up at the nodes.
    void integrate(View<Real> r) const;

    const FlatPatches<Real> &patches_;
    std::vector<Material> materials_;
    dealii::AlignedVector<Real> F_, stresses_; // (n_point_batches, 9, W)
    dealii::AlignedVector<Real> pressures_;    // (n_point_batches, W) lambda v, where it is costly
  };
} // namespace softcell
