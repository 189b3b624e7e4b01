// SPDX-License-Identifier: LGPL-2.1-or-later
// Combines what is swept.

#include <softcell/studies/study_cases.h>

#include <softcell/base/exceptions.h>
#include <softcell/output/results.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>

namespace softcell
{
  namespace
  {
    /// The items of a list, or one empty item if there are none, so that a loop runs once and sets
    /// nothing.
    std::vector<std::string> list_or_blank(const std::string &text)
    {
      std::vector<std::string> items = dealii::Utilities::split_string_list(text);
      items.erase(std::remove(items.begin(), items.end(), ""), items.end());
      return items.empty() ? std::vector<std::string>{""} : items;
    }

    /// The same of whole numbers, each written in one way only.
    std::vector<std::string> numbers(const std::string &text)
    {
      std::vector<std::string> items = list_or_blank(text);
      for (std::string &item : items)
        if (!item.empty())
          item = std::to_string(dealii::Utilities::string_to_int(item));
      return items;
    }

    /// `tetrahedra 2` as method and degree; an empty degree if none is given.
    std::pair<std::string, std::string> method_and_degree(const std::string &text)
    {
      const std::size_t end = text.find_last_not_of("0123456789");
      if (end == std::string::npos || end + 1 == text.size())
        return {text, ""};
      return {dealii::Utilities::trim(text.substr(0, end + 1)), text.substr(end + 1)};
    }

    void check_methods(const std::string &methods)
    {
      if (methods.empty())
        return;
      const std::vector<std::string> known = method_names();
      for (const std::string &item : list_or_blank(methods))
      {
        const std::string method = method_and_degree(item).first;
        if (std::find(known.begin(), known.end(), method) != known.end())
          continue;
        std::string names;
        for (const std::string &name : known)
          names += (names.empty() ? "" : ", ") + name;
        throw BadInput("Study/Methods = '" + methods + "' asks for '" + method +
                       "'; give some of " + names + ".");
      }
    }

    /// The parts between single bars; `||` belongs to an expression.
    std::vector<std::string> split_at_bars(const std::string &text)
    {
      std::vector<std::string> parts(1);
      for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] != '|')
          parts.back() += text[i];
        else if (text.compare(i, 2, "||") == 0)
          parts.back() += text.substr(i++, 2);
        else
          parts.emplace_back();
      return parts;
    }

    /// `Section/Entry` of a setting.
    std::string entry_of(const std::string &setting)
    {
      return dealii::Utilities::trim(setting.substr(0, setting.find('=')));
    }

    /// Does the setting change what is deformed?
    bool is_of_problem(const std::string &setting)
    {
      for (const char *const section :
           {"Geometry/", "Regions/", "Material/", "Material ", "Loads/"})
        if (setting.rfind(section, 0) == 0)
          return true;
      return false;
    }

    Sweep::Choice read_choice(const std::string &entry, const std::string &text)
    {
      const std::size_t colon = text.find(':');
      Sweep::Choice choice;
      choice.label = dealii::Utilities::trim(text.substr(0, colon));
      if (colon == std::string::npos || choice.label.empty() ||
          choice.label.find('=') != std::string::npos)
        throw BadInput(entry + ": '" + dealii::Utilities::trim(text) +
                       "' has no label; write label: Section/Entry = value; Section/Entry = value "
                       "| label: ...");
      for (const std::string &setting :
           dealii::Utilities::split_string_list(text.substr(colon + 1), ';'))
      {
        if (setting.empty())
          continue;
        // one way to write it, `Section/Entry = value`
        std::string name;
        for (const std::string &part : dealii::Utilities::split_string_list(entry_of(setting), '/'))
          name += (name.empty() ? "" : "/") + part;
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || name.find('/') == std::string::npos)
          throw BadInput(entry + ", " + choice.label + ": '" + setting +
                         "' is no setting; write Section/Entry = value.");
        if (name.rfind("Study/", 0) == 0 || name.rfind("Sweeps/", 0) == 0 ||
            name == "Output/Directory")
          throw BadInput(entry + ", " + choice.label + ": " + name +
                         " is of the study as a whole and cannot be swept; remove it.");
        choice.settings.push_back(name + " = " +
                                  dealii::Utilities::trim(setting.substr(equals + 1)));
      }
      return choice;
    }

    /// A sweep has a column of its own.
    void check_columns(const Parameters &parameters, const std::vector<Sweep> &sweeps)
    {
      std::vector<std::string> columns = results_columns();
      const auto add_vector            = [&](const std::string &name) {
        for (const char *const axis : {"x", "y", "z"})
          columns.push_back(name + axis);
      };
      for (const auto &[name, value] : parameters.probes)
        add_vector(name + "_u");
      for (const auto &[name, value] : parameters.regions)
        add_vector(name + "_f");
      add_vector("gravity_f");
      for (const Sweep &sweep : sweeps)
        if (std::find(columns.begin(), columns.end(), sweep.name) != columns.end())
          throw BadInput("Sweeps/" + sweep.name +
                         " has the name of another column of results.csv; give it another one.");
    }

    /// What may stand in the name of a file.
    std::string file_safe(std::string text)
    {
      for (char &c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) &&
            std::string("+-.").find(c) == std::string::npos)
          c = '_';
      return text;
    }

    /// All combinations of the sweeps; their names are the labels, each behind an underscore.
    std::vector<StudyCase> combinations(const std::vector<Sweep> &sweeps)
    {
      std::vector<StudyCase> cases(1);
      for (const Sweep &sweep : sweeps)
      {
        std::vector<StudyCase> longer;
        for (const StudyCase &one : cases)
          for (const Sweep::Choice &choice : sweep.choices)
          {
            StudyCase next = one;
            next.name += '_' + file_safe(choice.label);
            next.labels.emplace_back(sweep.name, choice.label);
            for (const std::string &setting : choice.settings)
            {
              next.settings.push_back(setting);
              if (is_of_problem(setting))
                next.problem_settings.push_back(setting);
            }
            if (next.problem_settings.size() > one.problem_settings.size())
              next.problem += '_' + file_safe(choice.label);
            longer.push_back(next);
          }
        cases = longer;
      }
      return cases;
    }

    /// What the case sets an entry to, or else `otherwise`.
    std::string value(const StudyCase &one, const std::string &entry, const std::string &otherwise)
    {
      for (const std::string &setting : one.settings)
        if (entry_of(setting) == entry)
          return dealii::Utilities::trim(setting.substr(setting.find('=') + 1));
      return otherwise;
    }

    void check_cases(const std::vector<StudyCase> &cases)
    {
      std::vector<std::string> names;
      for (const StudyCase &one : cases)
      {
        if (std::find(names.begin(), names.end(), one.name) != names.end())
          throw BadInput("Study asks for the case " + one.name +
                         " twice; remove one from its lists or sweeps.");
        names.push_back(one.name);
        std::vector<std::string> entries;
        for (const std::string &setting : one.settings)
        {
          const std::string entry = entry_of(setting);
          if (std::find(entries.begin(), entries.end(), entry) != entries.end())
            throw BadInput("Study, case " + one.name + ": " + entry +
                           " is swept twice; remove it from Sweeps or from Study.");
          entries.push_back(entry);
        }
      }
    }
  } // namespace

  std::vector<Sweep> read_sweeps(const std::vector<ParameterFile::Entry> &entries)
  {
    std::vector<Sweep> sweeps;
    for (const auto &[name, text] : entries)
    {
      const std::string entry = "Sweeps/" + name;
      Sweep sweep{name, {}};
      for (const std::string &part : split_at_bars(text))
      {
        sweep.choices.push_back(read_choice(entry, part));
        for (std::size_t i = 0; i + 1 < sweep.choices.size(); ++i)
          if (sweep.choices[i].label == sweep.choices.back().label)
            throw BadInput(entry + " has the label '" + sweep.choices[i].label +
                           "' twice; give each its own.");
      }
      sweeps.push_back(sweep);
    }
    return sweeps;
  }

  std::vector<StudyCase> study_cases(const Parameters &parameters)
  {
    const StudyParameters &study = parameters.study;
    if (!study.cells.empty() && !parameters.discretization.mesh.file.empty())
      throw BadInput("Study/Cells = " + study.cells + " changes nothing about the mesh of " +
                     "Discretization/Mesh file = " + parameters.discretization.mesh.file +
                     "; remove one of the two.");
    check_methods(study.methods);
    const std::vector<Sweep> sweeps = read_sweeps(parameters.sweeps);
    check_columns(parameters, sweeps);

    std::vector<StudyCase> cases;
    bool has_levels = study.cut_levels.empty();
    for (const StudyCase &swept : combinations(sweeps))
      for (const std::string &item : list_or_blank(study.methods))
      {
        const auto [named_method, own_degree] = method_and_degree(item);
        const std::string method =
          item.empty() ? value(swept, "Discretization/Method", parameters.discretization.method)
                       : named_method;
        const auto degrees =
          own_degree.empty() ? numbers(study.degrees) : std::vector<std::string>{own_degree};
        const auto levels =
          has_cut_levels(method) ? numbers(study.cut_levels) : std::vector<std::string>{""};
        has_levels = has_levels || has_cut_levels(method);
        for (const std::string &degree : degrees)
          for (const std::string &cells : numbers(study.cells))
            for (const std::string &level : levels)
            {
              StudyCase one  = swept;
              one.name       = file_safe(method);
              const auto set = [&](const std::string &entry, const std::string &text,
                                   const std::string &tag) {
                if (text.empty())
                  return;
                one.settings.push_back("Discretization/" + entry + " = " + text);
                one.name += tag;
              };
              set("Method", item.empty() ? "" : method, "");
              set("Degree", degree, "_p" + degree);
              set("Cells", cells, "_n" + cells);
              if (!cells.empty()) // which an edge length would win over
                set(method == "tetrahedra" ? "Mesh size" : "Cell size", "0", "");
              set("Cut levels", level, "_l" + level);
              one.name += swept.name;
              cases.push_back(one);
            }
      }
    if (!has_levels)
      throw BadInput("Study/Cut levels = " + study.cut_levels +
                     " means nothing to any of the methods; remove it.");
    check_cases(cases);
    return cases;
  }
} // namespace softcell
