// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by forces on the boundary: springs, penalty and Nitsche's method.
#pragma once

#include <softcell/discretization/evaluation.h>
#include <softcell/loads/expression.h>
#include <softcell/loads/load.h>

namespace softcell
{
  /// A boundary that is held near an imposed displacement g by forces that grow with the misfit
  /// u - g. Components in which g is `free` have no misfit.
  class Support : public Load
  {
  public:
    void add_couplings(std::vector<std::vector<unsigned int>> &couplings) const override;
    const std::string &region() const override
    {
      return region_;
    }

  protected:
    /// @param displacement g, at load factor t. Units: m
    Support(const Discretization &discretization,
            std::vector<SurfacePatch> patches,
            Expression displacement,
            std::string region);

    /// u - g at point q of a patch.
    Direction misfit(const SurfacePatch &patch, unsigned int q, const Vector &u, double t) const;

    const Discretization &discretization_;
    std::vector<SurfacePatch> patches_;
    Expression displacement_;

  private:
    std::string region_;
  };

  /// Springs between the boundary and where it is imposed to be: the potential is
  /// 1/2 int k |u - g|^2 dA, the force on the body -k (u - g) per area (Brunet eq. 3.41, but a
  /// vector and not its norm). With g = 0 it is an elastic foundation.
  ///
  /// On the patches of nodal_surface_patches() with weights 1 it is Brunet's penalty at surface
  /// nodes (eq. 4.18 to 4.21) and k is in N/m.
  class Penalty : public Support
  {
  public:
    /// @param stiffness k, one component, may contain t, not scaled by t. Units: Pa/m
    Penalty(const Discretization &discretization,
            std::vector<SurfacePatch> patches,
            Expression displacement,
            Expression stiffness,
            std::string region);

    void add_residual(const Vector &u, double t, Vector &r) const override;
    void add_tangent(const Vector &u, double t, BlockMatrix &K) const override;
    double energy(const Vector &u, double t) const override;
    Direction total_force(const Vector &u, double t) const override;

  private:
    Expression stiffness_;
  };

  /// Nitsche's method for finite strain, from the potential
  ///   Pi = -int P(F) N . (u - g) dA + 1/2 int gamma/h |u - g|^2 dA,
  ///   gamma = factor p^2 (lambda + 2 mu),
  /// with h the size of the cell and p the degree of its shapes. The residual is its exact
  /// derivative, so the exact solution satisfies the discrete equations. The tangent leaves out
  /// the second derivative of P, which is multiplied by u - g: it is exact for the linear law and
  /// symmetric always.
  ///
  /// The tangent of body and support is positive definite where factor p^2 exceeds the constant C
  /// of the trace inequality, int |v|^2 dA <= C/h int |v|^2 dV for the gradients v of shapes:
  /// (p + 1)^2 for a whole cell. It grows as the filled part of a cut cell vanishes, so slivers
  /// need a larger factor.
  class Nitsche : public Support
  {
  public:
    /// @param materials one per label; they outlive this.
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
    /// int P N dA - int gamma/h (u - g) dA.
    Direction total_force(const Vector &u, double t) const override;

  private:
    /// The integrand's parts at a point of the surface.
    struct Terms
    {
      Direction misfit;   // Units: m
      Direction traction; // P N in the components that are held. Units: Pa
      Gradient change;    // dP/dF : (misfit (x) N). Units: Pa m
      double stiffness;   // gamma/h. Units: Pa/m
    };
    Terms terms(const SurfacePatch &patch, unsigned int q, const Vector &u, double t) const;
    void check_admissible(const Vector &u) const;

    const std::vector<Material> &materials_;
    double factor_;
  };
} // namespace softcell
