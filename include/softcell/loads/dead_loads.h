// SPDX-License-Identifier: LGPL-2.1-or-later
// Forces that keep their direction and size however the body moves: weight and dead traction.
#pragma once

#include <softcell/loads/expression.h>
#include <softcell/loads/load.h>

namespace softcell
{
  /// A force that does not depend on u: its nodal forces are integrated once, or once per t if
  /// they are not proportional to t.
  class DeadLoad : public Load
  {
  public:
    void add_residual(const Vector &u, double t, Vector &r) const override;
    bool is_proportional() const override
    {
      return is_proportional_;
    }

    /// -int f . u
    double energy(const Vector &u, double t) const override;
    Direction total_force(const Vector &u, double t) const override;
    const std::string &region() const override
    {
      return region_;
    }

  protected:
    DeadLoad(const Discretization &discretization, std::string region, bool is_proportional);

    /// Adds the nodal forces at t of this rank's patches to f, which has ghost entries. Units: N
    virtual void integrate(double t, Vector &f) const = 0;

    /// Adds the nodal forces of a force at a point to f.
    /// @param shapes (n_nodes) values there.
    static void add_force(const Direction &force,
                          View<const unsigned int> nodes,
                          const double *shapes,
                          Vector &f);

    const Discretization &discretization_;

  private:
    /// Nodal forces at t over `factor`; ghost entries hold what is still to be sent.
    const Vector &forces(double t, double &factor) const;

    std::string region_;
    bool is_proportional_; // f(t) = t f(1)
    mutable Vector forces_;
    mutable double time_of_forces_;
  };

  /// Weight: f_i = t int rho g N_i dV.
  class Weight : public DeadLoad
  {
  public:
    /// @param gravity   Units: m/s^2
    /// @param densities one per material label. Units: kg/m^3
    Weight(const Discretization &discretization,
           const Direction &gravity,
           std::vector<double> densities);

  protected:
    void integrate(double t, Vector &f) const override;

  private:
    Direction gravity_;
    std::vector<double> densities_;
  };

  /// Dead traction: f_i = int t N_i dA over the reference surface (Brunet eq. 2.11; eq. 4.14 to
  /// 4.17 if the patches are those of nodal_surface_patches()).
  class Traction : public DeadLoad
  {
  public:
    /// @param traction three components, at load factor t. Units: Pa
    Traction(const Discretization &discretization,
             std::vector<SurfacePatch> patches,
             Expression traction,
             std::string region);

  protected:
    void integrate(double t, Vector &f) const override;

  private:
    std::vector<SurfacePatch> patches_;
    Expression traction_;
  };
} // namespace softcell
