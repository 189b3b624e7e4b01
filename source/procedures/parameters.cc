// SPDX-License-Identifier: LGPL-2.1-or-later
// Declares the sections of a parameter file.

#include <softcell/procedures/parameters.h>

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <functional>

namespace softcell
{
  const char *const free_sections = R"(# In these sections you name the entries; NAME is yours.
#
# subsection Regions   # parts of the body's surface
#   set NAME = an expression of x, y, z (m) and of the outward normal nx, ny, nz that is true there,
#              as z < 0.05 && nz < -0.3; or `patch K` of a surface file
# end
# subsection Loads     # NAME is that of a region; several loads of it are separated by ;
#   set NAME = clamp
#   set NAME = displacement 0, free, 0.01   (m; free leaves a component to itself)
#   set NAME = traction 0, -30, 0           (Pa; keeps its direction)
#   set NAME = pressure 1733                (Pa; inward, follows the surface)
#   set NAME = springs 1e6                  (Pa/m; towards the place at rest)
#   set NAME = displacement exact           (or traction exact, of the manufactured solution)
#   set NAME = displacement reference       (that of Study/Reference, for a study's cases)
#   set NAME = displacement path            (that of Path, a recorded one)
#              Values are expressions of x, y, z and of the load factor t, which goes from 0 to 1;
#              of those without t, t times the value acts, but springs are there from the start.
# end
# subsection Probes    # points of the body at rest whose displacement is reported
#   set NAME = 0, 0, 0.6                    (m)
# end
# subsection Sweeps    # for a study: a column NAME of results.csv, and what its labels stand for
#   set NAME = soft: Material/Young modulus = 500 | stiff: Material/Young modulus = 5e4; Loads/Gravity = 0, 0, 0
#              Every label is combined with those of the other sweeps and with the lists of Study; a label
#              without settings leaves the file as it is (`with: | without: Loads/Gravity = 0, 0, 0`).
# end
# subsection Material NAME   # as Material, for a label of an image or a closed patch of a surface
# end
)";

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
                      "Units: 1. Below 0.5; near it trilinear cells come out too stiff without "
                      "'Discretization/Volumetric projection', and linear tetrahedra in any case.");
    prm.add_parameter("Density", density, "Units: kg/m^3. Needed for weight and inertia.");
  }

  void ProcedureParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Mode", mode,
                      "static: equilibrium under loads that grow slowly; dynamic: motion in time, "
                      "see section Dynamics, where t is the time and loads that do not speak of it "
                      "act in full from the start.",
                      dealii::Patterns::Selection("static|dynamic"));
    prm.add_parameter(
      "Start from", start_from,
      "checkpoint.h5 of an earlier run on the same grid or mesh: the run starts from its "
      "displacement and goes on with the load where it stopped. Empty: from the body at rest.");
    prm.add_parameter(
      "Coarse grids", coarse_grids,
      "How many coarser grids or meshes are solved first, each with cells of twice the edge of the "
      "next: the run starts from the last one's displacement under the whole load, and from rest "
      "if that fails.",
      dealii::Patterns::Integer(0, 10));
  }

  void DynamicsParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.add_parameter("Steps per second", steps_per_second,
                      "Units: 1/s. 60 is what a display shows.", Double(1e-6));
    prm.add_parameter("End time", end_time, "Units: s. 0: the last time of Loads/Path.",
                      Double(0.));
    prm.add_parameter("Scheme", scheme,
                      "implicit Euler (Baraff and Witkin): of first order, damps what is fast and "
                      "is the one to interact with; Newmark (average acceleration): of second "
                      "order, damps nothing. Both solve one linear system a step.",
                      dealii::Patterns::Selection("implicit Euler|Newmark"));
    prm.add_parameter("Mass damping", mass_damping,
                      "Units: 1/s. a of Rayleigh's damping a M + b K.", Double(0.));
    prm.add_parameter("Stiffness damping", stiffness_damping,
                      "Units: s. b of Rayleigh's damping a M + b K.", Double(0.));
    prm.add_parameter(
      "Frame budget", frame_budget,
      "Units: ms. After so long a step leaves its linear system as it is, in single "
      "precision. 0: solve to 'Solver/Linear tolerance', in double precision.",
      Double(0.));
  }

  void OutputParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Directory", directory,
                      "Folder for what the run writes; runs/NAME for NAME.prm if empty.");
    prm.add_parameter("Volume", volume,
                      "Write solution.pvd: displacement, von Mises stress, J and cut fraction.");
    prm.add_parameter("Surface", surface, "Write surface.vtp: the body's own surface, deformed.");
    prm.add_parameter("Checkpoint", checkpoint,
                      "Write checkpoint.h5: node positions, displacement and load factor, from "
                      "which 'Solver/Start from' goes on.");
    prm.add_parameter("Every", every,
                      "Load steps, or steps in time, from one state to the next that solution.pvd "
                      "gets; checkpoint.h5 "
                      "has the latest of them. 0: the last state alone.",
                      dealii::Patterns::Integer(0));
  }

  void StudyParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Methods", methods,
      "List of methods to compare, each with a degree behind it if it is not to run "
      "with all Degrees: `finite cell, weighted cell, tetrahedra 1, tetrahedra 2`.");
    const auto numbers = [](const int smallest) {
      return dealii::Patterns::List(dealii::Patterns::Integer(smallest));
    };
    prm.add_parameter("Degrees", degrees, "List of degrees; Discretization/Degree if empty.",
                      numbers(1));
    prm.add_parameter("Cells", cells,
                      "List of numbers of cells across the shortest side; tetrahedra get edges of "
                      "that size.",
                      numbers(1));
    prm.add_parameter("Cut levels", cut_levels, "List of levels, for the methods that cut cells.",
                      numbers(0));
    prm.add_parameter(
      "Reference", reference,
      "Settings, separated by semicolons, of a run whose displacement all others "
      "are measured against: `Discretization/Method = tetrahedra; "
      "Discretization/Degree = 2; Discretization/Mesh size = 0.01`. Where Sweeps "
      "change Geometry, Regions, Material or Loads, it is run once for each of that.");
    prm.add_parameter("Resume", resume,
                      "Keep the cases that are in the output folder already, solved with the same "
                      "parameters, commit and number of ranks; false solves them again.");
  }

  void Parameters::add_parameters(dealii::ParameterHandler &prm)
  {
    in_section(prm, "Geometry", [&] { geometry.add_parameters(prm); });
    in_section(prm, "Regions", [] {});
    in_section(prm, "Material", [&] { material.add_parameters(prm); });
    in_section(prm, "Discretization", [&] { discretization.add_parameters(prm); });
    in_section(prm, "Loads", [&] { loads.add_parameters(prm); });
    in_section(prm, "Solver", [&] {
      procedure.add_parameters(prm);
      newton.add_parameters(prm);
      load_steps.add_parameters(prm);
      linear_solver.add_parameters(prm);
    });
    in_section(prm, "Dynamics", [&] { dynamics.add_parameters(prm); });
    in_section(prm, "Probes", [] {});
    in_section(prm, "Output", [&] { output.add_parameters(prm); });
    in_section(prm, "Study", [&] { study.add_parameters(prm); });
    in_section(prm, "Sweeps", [] {});
  }

  namespace
  {
    /// Names must differ, and so must the columns that they get in results.csv.
    /// @param reserved names that the section Loads uses itself.
    void check_names(const std::string &section,
                     const std::vector<ParameterFile::Entry> &entries,
                     const std::vector<std::string> &reserved = {})
    {
      std::vector<std::string> taken;
      for (const auto &[name, value] : entries)
      {
        const std::string entry = section + "/" + name + " = '" + value + "'";
        if (std::find(reserved.begin(), reserved.end(), name) != reserved.end())
          throw BadInput(entry + " has a name that Loads uses for itself; give it another one.");
        if (std::find(taken.begin(), taken.end(), name) != taken.end())
          throw BadInput(entry + " has the name of another entry; give it a name of its own.");
        taken.push_back(name);
      }
    }

    /// On a surface, a section `Material PATCH` says that its closed parts are filled.
    void add_material_patches(Parameters &parameters)
    {
      std::vector<unsigned int> &labels = parameters.geometry.labels;
      for (const auto &[name, material] : parameters.label_materials)
        if (name.size() < 9 && name.find_first_not_of("0123456789") == std::string::npos &&
            std::find(labels.begin(), labels.end(), std::stoul(name)) == labels.end())
          labels.push_back(std::stoul(name));
    }
  } // namespace

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
      parameters.sweeps        = text.declare_free_entries("Sweeps", prm);
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
    if (parameters.geometry.type == "surface")
      add_material_patches(parameters);

    dealii::ParameterHandler loads;
    parameters.loads.add_parameters(loads);
    std::vector<std::string> load_entries = {"gravity", "body_force"}; // columns of their own
    for (const auto &[name, value] : all_parameters(loads))
      load_entries.push_back(name);
    check_names("Regions", parameters.regions, load_entries);
    check_names("Probes", parameters.probes);
    check_names("Sweeps", parameters.sweeps);
    return parameters;
  }
} // namespace softcell
