// SPDX-License-Identifier: LGPL-2.1-or-later
// The list of methods.

#include <softcell/discretization/methods.h>

#include <softcell/base/exceptions.h>
#include <softcell/discretization/fitted.h>
#include <softcell/discretization/immersed.h>

#include <sstream>

namespace softcell
{
  namespace
  {
    /// Says so if a good part of the body is in no cell.
    void check_volume(const Discretization &discretization,
                      const Body &body,
                      std::vector<std::string> &remarks)
    {
      PatchStorage storage;
      double found = 0;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
        for (const double weight : discretization.patch(i, storage).weights)
          found += weight;
      found                 = dealii::Utilities::MPI::sum(found, discretization.communicator());
      const double expected = body.volume();
      if (found > 0.95 * expected)
        return;
      std::ostringstream text;
      text.precision(4);
      text << "The cells hold only " << found << " m^3 of the body's " << expected
           << " m^3; more Discretization/Cells, more Cut levels or a smaller Smallest volume "
              "fraction bring them together.";
      remarks.push_back(text.str());
    }
  } // namespace

  void DiscretizationParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    std::string names;
    for (const std::string &name : method_names())
      names += (names.empty() ? "" : "|") + name;
    prm.add_parameter(
      "Method", method,
      "How displacements are represented and integrated: hexahedra of a background "
      "grid that the body cuts (finite cell, weighted cell, moment fitting, sparse grid), or a "
      "conforming mesh (tetrahedra; hexahedra of a box or a cylinder).",
      dealii::Patterns::Selection(names));
    prm.add_parameter("Degree", degree, "Degree of the shape functions; 1 or 2 for tetrahedra.",
                      dealii::Patterns::Integer(1, 8));
    prm.add_parameter("Volumetric projection", projection,
                      "Take from the energy of volume changes in each cell only the part of one "
                      "degree less than the shape functions, at degree 1 that of the cell's mean "
                      "change (mean dilatation, B-bar): nearly incompressible materials then do "
                      "not lock. It changes nothing for tetrahedra.");
    grid.add_parameters(prm);
    cut.add_parameters(prm);
    mesh.add_parameters(prm);
    refinement.add_parameters(prm);
  }

  void RefinementParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Refinement steps", steps,
      "How often the problem is solved again on a background grid of degree 1 whose "
      "cells are halved where the estimated error of the stress is largest. solution.pvd has the "
      "states of the last grid, and checkpoint.h5 that grid too.",
      dealii::Patterns::Integer(0, 8));
    prm.add_parameter("Refined fraction", fraction,
                      "At each of the refinement steps the fewest cells are halved that hold this "
                      "part of the squared error; 1 halves all. Units: 1",
                      dealii::Patterns::Double(0.01, 1));
  }

  std::vector<std::string> method_names()
  {
    std::vector<std::string> names = {"tetrahedra", "hexahedra"};
    for (const std::string &name : cut_rule_names())
      names.push_back(name);
    return names;
  }

  bool has_cut_levels(const std::string &method)
  {
    return method == "finite cell" || method == "weighted cell" || method == "moment fitting";
  }

  std::unique_ptr<Discretization> make_discretization(const DiscretizationParameters &parameters,
                                                      const GeometryParameters &geometry,
                                                      const Body &body,
                                                      MPI_Comm communicator,
                                                      std::vector<std::string> &remarks,
                                                      const Refinement &refinement)
  {
    const bool is_mesh = parameters.method == "tetrahedra" || parameters.method == "hexahedra";
    if (parameters.refinement.steps > 0 && (is_mesh || parameters.degree > 1))
      throw BadInput("Discretization/Refinement steps = " +
                     std::to_string(parameters.refinement.steps) + " is not available for " +
                     parameters.method + " of degree " + std::to_string(parameters.degree) +
                     ", only for background grids of degree 1; set it to 0.");
    if (is_mesh)
      return std::make_unique<Fitted>(
        communicator,
        make_mesh(communicator,
                  parameters.method == "tetrahedra" ? CellShape::tetrahedra : CellShape::hexahedra,
                  parameters.grid.cells, parameters.mesh, geometry, body, remarks),
        parameters.degree, body);
    auto immersed =
      std::make_unique<Immersed>(parameters.method, parameters.degree, parameters.grid,
                                 parameters.cut, body, communicator, refinement);
    check_volume(*immersed, body, remarks);
    return immersed;
  }
} // namespace softcell
