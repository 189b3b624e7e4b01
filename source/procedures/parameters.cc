// SPDX-License-Identifier: LGPL-2.1-or-later
// Declares the sections of a parameter file.

#include <softcell/procedures/parameters.h>

#include <functional>

namespace softcell
{
  namespace
  {
    void in_section(dealii::ParameterHandler &prm,
                    const std::string &section,
                    const std::function<void()> &declare)
    {
      prm.enter_subsection(section);
      declare();
      prm.leave_subsection();
    }
  } // namespace

  void MaterialParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Model", model, "Law of the material (Brunet, section 2.3).",
                      dealii::Patterns::Selection("Neo-Hookean|Saint-Venant-Kirchhoff|linear"));
    prm.add_parameter("Young modulus", young_modulus,
                      "Units: Pa. Greater than 0; soft organs have 1e3 to 1e5.");
    prm.add_parameter("Poisson ratio", poisson_ratio,
                      "Units: 1. Below 0.5; from 0.49 on trilinear cells and linear tetrahedra "
                      "come out too stiff.");
    prm.add_parameter("Density", density, "Units: kg/m^3. Needed for the weight only.");
  }

  void OutputParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Directory", directory,
                      "Folder for what the run writes; runs/NAME for NAME.prm if empty.");
    prm.add_parameter("Volume", volume,
                      "Write solution.pvd: displacement, von Mises stress, J and cut fraction.");
    prm.add_parameter("Surface", surface, "Write surface.vtp: the body's own surface, deformed.");
    prm.add_parameter("Checkpoint", checkpoint, "Write checkpoint.h5: positions, displacement.");
  }

  void StudyParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Methods", methods,
      "List of methods to compare, each with a degree behind it if it is not to run "
      "with all Degrees: `finite cell, weighted cell, tetrahedra 1, tetrahedra 2`.");
    prm.add_parameter("Degrees", degrees, "List of degrees; Discretization/Degree if empty.");
    prm.add_parameter("Cells", cells,
                      "List of numbers of cells across the shortest side; tetrahedra get edges of "
                      "that size.");
    prm.add_parameter("Cut levels", cut_levels, "List of levels, for the methods that cut cells.");
    prm.add_parameter("Reference", reference,
                      "Settings, separated by semicolons, of a run whose displacement all others "
                      "are measured against: `Discretization/Method = tetrahedra; "
                      "Discretization/Degree = 2; Discretization/Mesh size = 0.01`.");
  }

  void Parameters::add_parameters(dealii::ParameterHandler &prm)
  {
    in_section(prm, "Geometry", [&] { geometry.add_parameters(prm); });
    in_section(prm, "Regions", [] {});
    in_section(prm, "Material", [&] { material.add_parameters(prm); });
    in_section(prm, "Discretization", [&] { discretization.add_parameters(prm); });
    in_section(prm, "Loads", [&] { loads.add_parameters(prm); });
    in_section(prm, "Solver", [&] {
      newton.add_parameters(prm);
      load_steps.add_parameters(prm);
      linear_solver.add_parameters(prm);
    });
    in_section(prm, "Probes", [] {});
    in_section(prm, "Output", [&] { output.add_parameters(prm); });
    in_section(prm, "Study", [&] { study.add_parameters(prm); });
  }

  Parameters read_parameters(const std::string &file, const std::vector<std::string> &settings)
  {
    ParameterFile text(file, settings);
    Parameters parameters;

    // Twice: what a section `Material LABEL` leaves out is as in Material, which must be known
    // first.
    for (const bool is_final : {false, true})
    {
      dealii::ParameterHandler prm;
      parameters.add_parameters(prm);
      parameters.regions       = text.declare_free_entries("Regions", prm);
      parameters.load_entries  = text.declare_free_entries("Loads", prm);
      parameters.probes        = text.declare_free_entries("Probes", prm);
      const std::string prefix = "Material ";
      for (const std::string &section : text.sections(prefix))
      {
        MaterialParameters &material = parameters.label_materials[section.substr(prefix.size())];
        material                     = parameters.material;
        in_section(prm, section, [&] { material.add_parameters(prm); });
      }
      text.parse(prm);
      if (is_final)
        parameters.entries = all_parameters(prm);
    }
    return parameters;
  }
} // namespace softcell
