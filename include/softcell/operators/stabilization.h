// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cells of which the body fills little.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/material.h>

#include <vector>

namespace softcell
{
  /// A soft linear material beside the body in cut cells, with the body's Lame parameters times
  /// alpha: energy sum over cells of alpha int W(u) dV over what is not filled.
  ///
  /// The body does not feel it but where a cell holds so little of the body that its nodes would
  /// hardly be held at all. It is geometrically linear, so that its tangent is constant and it may
  /// be turned inside out. Source: Schillinger et al., Small and large deformation analysis with
  /// the p- and B-spline versions of the Finite Cell Method, Comput. Mech. 50 (2012). All members
  /// are collective; u needs its ghost values up to date.
  class Stabilization
  {
  public:
    /// @param materials one per label.
    Stabilization(const Discretization &discretization, const std::vector<Material> &materials);

    /// Units: J
    double energy(const Vector &u) const;

    /// Adds the force to r; the caller compresses. Units: N
    void add_residual(const Vector &u, Vector &r) const;

    /// Adds the tangent to K; the caller compresses. Units: N/m
    void add_tangent(BlockMatrix &K) const;

  private:
    template <class Function>
    void for_each_patch(const Vector &u, const Function &function) const;

    const Discretization &discretization_;
    std::vector<LinearElastic<>> laws_;
  };
} // namespace softcell
