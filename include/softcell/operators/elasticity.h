// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body, assembled patch by patch.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/material.h>

#include <vector>

namespace softcell
{
  /// Averages over the material of each patch of this rank, for pictures.
  struct PatchAverages
  {
    std::vector<double> von_mises; // (n_patches) of the Cauchy stress. Units: Pa
    std::vector<double> jacobian;  // (n_patches) det F. Units: 1
  };

  /// Energy, internal force and tangent of a hyperelastic body on any discretization.
  ///
  /// With W the energy density and F = I + du/dX: energy = int W, residual_i = int P : dN_i/dX
  /// (Brunet eq. 2.17), tangent = d residual / du (eq. 2.27). All members are collective; u needs
  /// its ghost values up to date.
  ///
  /// With projection, residual and tangent can be had with the volumetric strain linearised at a
  /// `base`: pressures then change with u as those of Newton's method in displacement and pressure
  /// do, whose steps are not cut short by the second-order changes of volume that come with them.
  /// At u = base, both residuals are the same. Source: Magisano, Leonetti, Garcea (2017), who do
  /// so with the stress at each point.
  class Elasticity
  {
  public:
    /// @param materials      one per label.
    /// @param has_projection whether the change of volume is projected on each patch onto
    /// polynomials of one degree less than the shapes, at degree 1 onto its mean: nearly
    /// incompressible materials then do not lock.
    Elasticity(const Discretization &discretization,
               std::vector<Material> materials,
               bool has_projection = false);

    /// Units: J. @throws InvertedPoint
    double energy(const Vector &u) const;

    /// Adds the internal force to r. The caller compresses (VectorOperation::add) when all loads
    /// are in. Units: N. @throws InvertedPoint
    void add_residual(const Vector &u, Vector &r, const Vector *base = nullptr) const;

    /// Adds the tangent to K; the caller compresses when all loads are in.
    /// Units: N/m. @throws InvertedPoint
    void add_tangent(const Vector &u, BlockMatrix &K, const Vector *base = nullptr) const;

    /// The node lists of this rank's patches, whose unknowns the tangent couples: for making K.
    std::vector<std::vector<unsigned int>> couplings() const;

    /// Points where the law has no value count as free of stress.
    PatchAverages averages(const Vector &u) const;

    /// Smallest det F over all integration points of the body.
    double min_jacobian(const Vector &u) const;

    /// Volume of the body as the quadrature sees it. Units: m^3
    double volume() const;

  private:
    template <class Function>
    void for_each_patch(const Function &function) const;

    const Discretization &discretization_;
    std::vector<Material> materials_;
    bool has_projection_;
  };
} // namespace softcell
