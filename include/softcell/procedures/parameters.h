// SPDX-License-Identifier: LGPL-2.1-or-later
// Everything that a parameter file says, section by section.
#pragma once

#include <softcell/base/parameters.h>
#include <softcell/discretization/methods.h>
#include <softcell/geometry/geometry.h>
#include <softcell/loads/load_list.h>
#include <softcell/mechanics/material.h>
#include <softcell/solvers/lattice_motion.h>
#include <softcell/solvers/linear_solver.h>
#include <softcell/solvers/load_steps.h>
#include <softcell/solvers/newton.h>

#include <map>
#include <string>
#include <vector>

namespace softcell
{
  /// Section Material, and each section `Material LABEL` for a label that differs.
  struct MaterialParameters
  {
    std::string model    = "Neo-Hookean";
    double young_modulus = 5000; // Pa
    double poisson_ratio = 0.45;
    double density       = 1000; // kg/m^3

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What the section Solver says beside Newton's method, load steps and linear solver.
  struct ProcedureParameters
  {
    std::string mode          = "static"; // or dynamic
    std::string start_from    = "";       // a checkpoint; empty: the body at rest
    unsigned int coarse_grids = 0;        // that are solved first, each as a start for the next

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Section Dynamics, for a body in motion.
  struct DynamicsParameters
  {
    double steps_per_second  = 60;
    double end_time          = 0; // s; 0: that of the recorded path
    std::string scheme       = "implicit Euler";
    double mass_damping      = 0; // 1/s
    double stiffness_damping = 0; // s
    double frame_budget      = 0; // ms; 0: as long as it takes

    void add_parameters(dealii::ParameterHandler &prm);

    MotionParameters motion() const
    {
      return {scheme == "Newmark" ? TimeScheme::newmark : TimeScheme::implicit_euler, mass_damping,
              stiffness_damping};
    }
  };

  /// Section Output.
  struct OutputParameters
  {
    std::string directory = "";    // empty: runs/NAME of the parameter file
    bool volume           = true;  // solution.pvd
    bool surface          = true;  // surface.vtp
    bool checkpoint       = false; // HDF5
    unsigned int every    = 0;     // load steps or frames between states; 0: the last state alone

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Section Study: what is swept. Lists are empty where nothing is.
  struct StudyParameters
  {
    std::string methods, degrees, cells, cut_levels, reference;
    bool resume = true; // keep the cases that are in the folder already

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What may stand in the sections whose entries the user names, as comments of a parameter file.
  extern const char *const free_sections;

  /// One parameter file, read.
  struct Parameters
  {
    GeometryParameters geometry;
    std::vector<ParameterFile::Entry> regions;
    MaterialParameters material;
    std::map<std::string, MaterialParameters> label_materials; // by the label's name
    DiscretizationParameters discretization;
    LoadParameters loads;
    std::vector<ParameterFile::Entry> load_entries;
    ProcedureParameters procedure;
    NewtonParameters newton;
    LoadStepParameters load_steps;
    LinearSolverParameters linear_solver;
    DynamicsParameters dynamics;
    std::vector<ParameterFile::Entry> probes;
    OutputParameters output;
    StudyParameters study;
    std::vector<ParameterFile::Entry> sweeps;

    std::vector<ParameterFile::Entry> entries; // all of them as they were read, for the record

    /// Declares every entry but the free ones.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Reads FILE.prm with `Section/Entry = value` in its place for each of the settings. Collective.
  /// @throws BadInput
  Parameters read_parameters(const std::string &file, const std::vector<std::string> &settings);
} // namespace softcell
