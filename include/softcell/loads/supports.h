// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed by forces on the boundary: springs and penalty.
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
    bool is_proportional() const override
    {
      return !displacement_.uses_time();
    }
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
  /// A factor of k that differs from patch to patch may stand in their weights. With weights of 1
  /// on nodal_surface_patches(), k is in N/m and this is Brunet's penalty at surface nodes
  /// (eq. 4.18 to 4.21).
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
} // namespace softcell
