// SPDX-License-Identifier: LGPL-2.1-or-later
// What the sections Study and Sweeps ask for, as a list of cases.
#pragma once

#include <softcell/procedures/parameters.h>

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// One entry of section Sweeps: a column of results.csv, and what may stand in it.
  struct Sweep
  {
    struct Choice
    {
      std::string label;
      std::vector<std::string> settings; // each `Section/Entry = value`; may be empty
    };
    std::string name;
    std::vector<Choice> choices;
  };

  /// Reads `NAME = label: Section/Entry = value; Section/Entry = value | label: ...` of every
  /// sweep.
  /// @throws BadInput
  std::vector<Sweep> read_sweeps(const std::vector<ParameterFile::Entry> &entries);

  /// One run of a study: the settings that tell it from the others.
  struct StudyCase
  {
    std::string name; // finite_cell_p1_n8_l3_soft
    std::vector<std::string> settings;
    std::vector<std::pair<std::string, std::string>> labels; // name and label of each sweep

    /// Those of the settings that say what is deformed, not how: Geometry, Regions, Material,
    /// Loads.
    std::vector<std::string> problem_settings;
    std::string problem; // the labels that bring them, each behind an underscore
  };

  /// The cases of sections Study and Sweeps: all combinations, with cut levels only for the methods
  /// that have them. A study of nothing has one case, named after its method.
  /// @throws BadInput if two are the same, or one is given the same entry twice.
  std::vector<StudyCase> study_cases(const Parameters &parameters);
} // namespace softcell
