// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Discretization, and the method that it chooses.
#pragma once

#include <softcell/discretization/background_grid.h>
#include <softcell/discretization/discretization.h>
#include <softcell/discretization/mesh.h>
#include <softcell/geometry/geometry.h>
#include <softcell/quadrature/cut_rule.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// How a background grid is refined where an estimate of the error asks for it.
  struct RefinementParameters
  {
    unsigned int steps = 0;
    double fraction    = 0.5; // of the squared error, which the cells hold that are halved

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What the section Discretization of a parameter file says.
  struct DiscretizationParameters
  {
    std::string method  = "weighted cell"; // a cut-cell rule, `hexahedra` or `tetrahedra`
    unsigned int degree = 1;               // of the shape functions
    bool projection     = false;           // of the volumetric strain, on each patch
    GridParameters grid;
    CutParameters cut;
    MeshParameters mesh;
    RefinementParameters refinement;

    /// Declares the entries of the section, which the caller has entered.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What `Method` may be.
  std::vector<std::string> method_names();

  /// Does the entry `Cut levels` mean something to this method?
  bool has_cut_levels(const std::string &method);

  /// Builds the discretization of a body. Collective.
  /// @param geometry what the body was made from.
  /// @param remarks gets a sentence on whatever a user should know.
  /// @param refinement of a background grid; empty for a mesh.
  /// @throws BadInput
  std::unique_ptr<Discretization> make_discretization(const DiscretizationParameters &parameters,
                                                      const GeometryParameters &geometry,
                                                      const Body &body,
                                                      MPI_Comm communicator,
                                                      std::vector<std::string> &remarks,
                                                      const Refinement &refinement = {});
} // namespace softcell
