// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by Nitsche's method.
#pragma once

#include <softcell/loads/supports.h>
#include <softcell/mechanics/material.h>

#include <Eigen/Core>

namespace softcell
{
  /// Nitsche's method for finite strain, from the potential
  ///   Pi = -int theta P(F) N . (u - g) dA + 1/2 int gamma |u - g|^2 dA.
  /// The residual is its exact derivative, and the tangent that of the residual but for one part:
  /// theta d2P/dF2 N . (u - g) is left out where |u - g| > mu / (4 (lambda + 2 mu) theta C), C as
  /// below. There, as at the start of a load step in cells of which the body fills little, it would
  /// outweigh the stiffness of the cell, and Newton's method would fail: at rest and with u - g
  /// along N, the law of Saint-Venant and Kirchhoff takes (lambda + 2 mu) theta C |u - g| from the
  /// mu that resists gradients a (x) N in shear, and the Neo-Hookean one hardly less from others.
  ///
  /// The volume of a sliver does not control the gradients of its shapes on its surface S. So F is
  /// made of their projection, by the quadrature of the cell K that holds S, onto polynomials of
  /// degree p - 1: at p = 1 their mean over what is filled. A linear displacement loses nothing by
  /// it, a smooth one less than by the shapes. With polynomials phi_k that are orthonormal on K,
  ///   int_S |v|^2 dA <= C int_K |v|^2 dV,   C = sum_k int_S phi_k^2 dA
  /// for all such gradients v; at p = 1, C is the area of S by the volume of K and no smaller
  /// number would do. With gamma = factor (lambda + 2 mu) C and factor > 1 the tangent of body and
  /// support, at rest and where it should be, is thus positive definite in cells of one material,
  /// however small the cut is. (A cell that bears n supports needs factor > n; strains that stiffen
  /// the material and misfits need some more. In a cell of two materials, the softer one may hardly
  /// hold what strains the stiffer at S.)
  ///
  /// A gamma without bound would hold the surface of slivers as if by hand. Beyond
  /// `limit` (lambda + 2 mu)/h, h the size of the cell, it grows no more, and
  /// theta^2 = gamma / (factor (lambda + 2 mu) C), elsewhere 1, keeps the tangent positive
  /// definite: the support passes into a penalty, whose misfit is a thousandth of strain times h.
  ///
  /// Source: Embar, Dolbow, Harari (2010) on constants for each cell; de Prenter, Lehrenfeld,
  /// Massing (2018) on what they do on slivers. Departure: the projection, which needs no
  /// eigenvalue problem and has a finite C where a cell has fewer points than modes.
  class Nitsche : public Support
  {
  public:
    /// @param patches   the discretization's, not nodal ones.
    /// @param materials one per label; they outlive this.
    /// @param factor    safety over the stability bound, above 1.
    Nitsche(const Discretization &discretization,
            std::vector<SurfacePatch> patches,
            Expression displacement,
            const std::vector<Material> &materials,
            double factor,
            std::string region);

    /// Collective. @throws InvertedPoint on all ranks if a point of the surface is inverted.
    void add_residual(const Vector &u, double t, Vector &r) const override;
    void add_tangent(const Vector &u, double t, BlockMatrix &K) const override;
    /// @throws InvertedPoint as above.
    double energy(const Vector &u, double t) const override;
    /// int theta P N dA - int gamma (u - g) dA.
    Direction total_force(const Vector &u, double t) const override;

  private:
    static constexpr double limit = 1000;

    /// What a patch's terms are multiplied by.
    struct Factors
    {
      double stiffness;      // gamma / (lambda + 2 mu). Units: 1/m
      double flux;           // theta
      double largest_misfit; // 1 / (4 theta C), times (lambda + 2 mu) / mu too large. Units: m
    };
    /// The integrand's parts at a point of the surface.
    struct Terms
    {
      Matrix3<double> F;        // of the projected gradient
      Direction misfit;         // Units: m
      Direction traction;       // theta P N in the components that are held. Units: Pa
      Matrix3<double> misfit_N; // theta misfit (x) N. Units: m
      Matrix3<double> change;   // dP/dF : misfit_N. Units: Pa m
      double stiffness;         // gamma. Units: Pa/m
    };
    Terms terms(unsigned int patch, unsigned int q, const Vector &u, double t) const;
    /// The point's part of the tangent, weight included: with s_i = (N_i, dN_i/dX) of node i, its
    /// entry for component a of node i and component b of node j is s_i M_ab s_j, where M_ab are
    /// blocks of four rows and columns,
    ///   [ gamma, -d traction_a / dF_b ; -d traction_b / dF_a, -d change_a / dF_b ].
    using PointTangent = Eigen::Matrix<double, 12, 12>;
    PointTangent tangent(unsigned int patch, unsigned int q, const Terms &at_q) const;
    void check_admissible(const Vector &u) const;

    const std::vector<Material> &materials_;
    std::vector<Factors> factors_; // one per patch
  };
} // namespace softcell
