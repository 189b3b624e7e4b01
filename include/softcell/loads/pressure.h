// SPDX-License-Identifier: LGPL-2.1-or-later
// A pressure that follows the surface.
#pragma once

#include <softcell/loads/expression.h>
#include <softcell/loads/load.h>

namespace softcell
{
  /// Pressure on the deformed surface, inward if positive: f_i = -int p N_i J F^-T N dA (Nanson).
  ///
  /// F is that of the cell at the surface point. With a_1 = F t_1 and a_2 = F t_2, the images of
  /// two orthonormal tangents t_1 x t_2 = N, J F^-T N is a_1 x a_2: F need not be invertible. The
  /// skew part of the tangent is an integral over the rim of the region plus one over grad p:
  /// nothing for a uniform p on a closed surface or on one whose rim is held (Bonet and Wood,
  /// Nonlinear continuum mechanics, sec. 8.5).
  class Pressure : public Load
  {
  public:
    /// @param pressure one component, at load factor t. Units: Pa
    Pressure(const Discretization &discretization,
             std::vector<SurfacePatch> patches,
             Expression pressure,
             std::string region);

    void add_residual(const Vector &u, double t, Vector &r) const override;
    void add_tangent(const Vector &u, double t, BlockMatrix &K) const override;
    bool has_symmetric_tangent() const override
    {
      return false;
    }
    void add_couplings(std::vector<std::vector<unsigned int>> &couplings) const override;
    Direction total_force(const Vector &u, double t) const override;
    const std::string &region() const override
    {
      return region_;
    }

  private:
    const Discretization &discretization_;
    std::vector<SurfacePatch> patches_;
    Expression pressure_;
    std::string region_;
  };
} // namespace softcell
