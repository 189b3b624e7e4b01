// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Loads, and the loads that it describes.
#pragma once

#include <softcell/discretization/evaluation.h>
#include <softcell/geometry/surface.h>
#include <softcell/loads/imposed_displacement.h>
#include <softcell/loads/load.h>
#include <softcell/loads/load_description.h>
#include <softcell/loads/manufactured_solution.h>

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
    std::string manufactured        = "none";  // or one of manufactured_solution_names()
    double amplitude                = 0.05;    // of the manufactured solution. m
    std::string path                = "";      // file, see RecordedPath

    /// Declares the entries of the section, which the caller has entered.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What acts on a body and what holds it.
  struct Loads
  {
    std::vector<std::unique_ptr<Load>> forces; // with the supports that act by forces
    ImposedDisplacement imposed;
    std::string free_motions; // RigidModes::free_motions() of all supports; empty if none is free
    std::unique_ptr<const ManufacturedSolution> exact; // if there is one
    std::vector<std::string> warnings;                 // a sentence on each load that does nothing
  };

  /// Builds the loads on a discretization of a body. Collective.
  /// @param surface   of the body, for `Surface integration = nodal`.
  /// @param materials one per label; they outlive the result, as the discretization does.
  /// @param reference that loads `displacement reference` impose; may be null if there are none.
  /// @throws BadInput on all ranks.
  Loads make_loads(const LoadParameters &parameters,
                   const std::vector<LoadDescription> &descriptions,
                   const std::vector<Region> &regions,
                   const Discretization &discretization,
                   const Surface &surface,
                   const std::vector<Material> &materials,
                   const DisplacementField *reference = nullptr);
} // namespace softcell
