// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cells of which the body fills little.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/material.h>

#include <vector>

namespace softcell
{
  /// Two remedies for cells that hold so little of the body that their nodes are hardly held at
  /// all, both with a quadratic energy: a soft material beside the body in cut cells, and a penalty
  /// on jumps between cut cells and their neighbours.
  ///
  /// Both take min(lambda, 2 mu) for lambda: with all of a large one the first, at full Gauss
  /// points, would lock and the second hold nearly incompressible bodies from shearing too. Up to a
  /// Poisson's ratio of 1/3 it is the body's.
  ///
  /// The material has these Lame parameters times alpha and is geometrically linear, so that
  /// its tangent is constant and it may be turned inside out. Source: Schillinger et al., Small and
  /// large deformation analysis with the p- and B-spline versions of the Finite Cell Method,
  /// Comput. Mech. 50 (2012). The penalty vanishes where the displacement is one polynomial; the
  /// discretization tells its form. It is in proportion to lambda + 2 mu. All members are
  /// collective; u needs its ghost values up to date.
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

    /// Lists of nodes that the tangent couples beyond those of single patches.
    void add_couplings(std::vector<std::vector<unsigned int>> &couplings) const;

  private:
    template <class Function>
    void for_each_patch(const Vector &u, const Function &function) const;
    /// lambda + 2 mu of a law. Units: Pa
    double modulus(const GhostFace &face) const;
    /// The penalty's forces in the nodes of a face. Units: N
    std::vector<Direction> forces(const GhostFace &face, const Vector &u) const;

    const Discretization &discretization_;
    std::vector<LinearElastic<>> laws_; // lambda limited
  };
} // namespace softcell
