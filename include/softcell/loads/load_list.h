// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Loads, and the loads that it describes.
#pragma once

#include <softcell/geometry/surface.h>
#include <softcell/loads/imposed_displacement.h>
#include <softcell/loads/load.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// The fixed entries of the section Loads.
  struct LoadParameters
  {
    Direction gravity;                    // m/s^2
    std::string imposition = "automatic"; // automatic, strong, penalty, Nitsche
    std::string penalty    = "automatic"; // or an expression of x, y, z, t. Pa/m, or N/m if nodal
    double nitsche_factor  = 10;
    std::string surface_integration = "exact"; // exact, nodal

    /// Declares the entries of the section, which the caller has entered.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// One load of an entry `NAME = kind value; kind value; ...` of the section Loads.
  struct LoadDescription
  {
    enum class Kind
    {
      displacement,
      traction,
      pressure,
      springs
    };

    std::string region;
    Kind kind;
    std::string value; // its expressions
    std::string place; // `Loads/NAME = 'kind value'`, for messages
  };

  /// Reads entries (name of a region, text):
  ///   clamp | displacement ux, uy, uz | traction tx, ty, tz | pressure p | springs k
  /// with values in m, Pa and Pa/m that are expressions of x, y, z and t. Values that do not
  /// contain t are multiplied by the load factor t, but for k.
  /// @throws BadInput
  std::vector<LoadDescription>
  parse_loads(const std::vector<std::pair<std::string, std::string>> &entries,
              const std::vector<Region> &regions);

  /// What acts on a body and what holds it.
  struct Loads
  {
    std::vector<std::unique_ptr<Load>> forces; // with the supports that act by forces
    ImposedDisplacement imposed;
    std::string free_motions; // RigidModes::free_motions() of all supports; empty if none is free
  };

  /// Builds the loads on a discretization of a body. Collective.
  /// @param surface   of the body, for `Surface integration = nodal`.
  /// @param materials one per label; they outlive the result, as the discretization does.
  /// @throws BadInput on all ranks.
  Loads make_loads(const LoadParameters &parameters,
                   const std::vector<LoadDescription> &descriptions,
                   const std::vector<Region> &regions,
                   const Discretization &discretization,
                   const Surface &surface,
                   const std::vector<Material> &materials);
} // namespace softcell
