// SPDX-License-Identifier: LGPL-2.1-or-later
// A displacement that is known everywhere, and the loads that hold a body there.
#pragma once

#include <softcell/discretization/evaluation.h>
#include <softcell/loads/dead_loads.h>
#include <softcell/mechanics/material.h>

#include <array>
#include <string>
#include <vector>

namespace softcell
{
  /// A displacement field u(X) of space, given by a formula. At load factor t, the displacement t u
  /// is the equilibrium of a body of one material, of any shape, under the body force and the
  /// tractions that are told here. So the error of a discretization is known exactly.
  class ManufacturedSolution
  {
  public:
    /// @param name      one of manufactured_solution_names().
    /// @param amplitude factor of the field. Units: m
    ManufacturedSolution(const std::string &name, double amplitude);

    /// u. Units: m
    Direction displacement(const Point &X) const;

    /// [c][d] = du_c/dX_d. Units: 1
    Gradient gradient(const Point &X) const;

    /// -Div P(I + t du/dX). Units: N/m^3
    Direction body_force(const Material &material, const Point &X, double t) const;

    /// P(I + t du/dX) N. Units: Pa
    /// @param N unit outward normal of the reference surface.
    Direction
    traction(const Material &material, const Point &X, const Direction &N, double t) const;

    /// A field with its derivatives at a point.
    struct Jet
    {
      Direction value;
      Gradient gradient;
      std::array<Gradient, 3> changes; // of the gradient along x, y and z
    };

  private:
    Jet (*field_)(const Point &);
    double amplitude_;
  };

  /// All fields, by the names that a parameter file gives them.
  std::vector<std::string> manufactured_solution_names();

  /// The body force of a manufactured solution, for a body of one material.
  class ManufacturedBodyForce : public DeadLoad
  {
  public:
    /// @param solution,material outlive this.
    ManufacturedBodyForce(const Discretization &discretization,
                          const ManufacturedSolution &solution,
                          const Material &material);

  protected:
    void integrate(double t, Vector &f) const override;

  private:
    const ManufacturedSolution &solution_;
    const Material &material_;
  };

  /// The tractions of a manufactured solution on a part of the reference surface.
  class ManufacturedTraction : public DeadLoad
  {
  public:
    /// @param solution,material outlive this.
    ManufacturedTraction(const Discretization &discretization,
                         std::vector<SurfacePatch> patches,
                         const ManufacturedSolution &solution,
                         const Material &material,
                         std::string region);

  protected:
    void integrate(double t, Vector &f) const override;

  private:
    std::vector<SurfacePatch> patches_;
    const ManufacturedSolution &solution_;
    const Material &material_;
  };
} // namespace softcell
