// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes the runs of a study, leaves them in their folders and finds them again.

#include <softcell/studies/study_run.h>

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/loads/load_description.h>
#include <softcell/output/fingerprint.h>
#include <softcell/studies/study_cases.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <cmath>
#include <new>

namespace softcell
{
  namespace
  {
    /// Reads the file with more settings, of which `what` says where they come from.
    Parameters read_run(const std::string &file,
                        std::vector<std::string> settings,
                        const std::vector<std::string> &more,
                        const std::string &what)
    {
      settings.insert(settings.end(), more.begin(), more.end());
      try
      {
        return read_parameters(file, settings);
      }
      catch (const BadInput &error)
      {
        throw BadInput(more.empty() ? error.what() : what + ": " + error.what());
      }
    }

    /// The run that the errors of a case are measured against.
    StudyRun reference_of(const StudyCase &study_case,
                          const std::string &reference,
                          const std::string &file,
                          const std::vector<std::string> &settings)
    {
      std::vector<std::string> all = study_case.problem_settings;
      for (const std::string &setting : dealii::Utilities::split_string_list(reference, ';'))
        if (!setting.empty())
          all.push_back(setting);
      StudyRun run;
      run.name                         = "reference" + study_case.problem;
      run.parameters                   = read_run(file, settings, all, "Study/Reference");
      run.parameters.output.checkpoint = true;
      return run;
    }
  } // namespace

  bool imposes_reference(const Parameters &parameters)
  {
    const std::vector<LoadDescription> loads =
      parse_loads(parameters.load_entries, make_regions(parameters.regions));
    return std::any_of(loads.begin(), loads.end(),
                       [](const LoadDescription &load) { return load.is_of_reference(); });
  }

  Work work_of(const Parameters &parameters, const double points, const double unknowns)
  {
    return {parameters.discretization.method + std::to_string(parameters.discretization.degree),
            points, unknowns};
  }

  std::vector<ParameterFile::Entry> own_entries(const Parameters &parameters)
  {
    std::vector<ParameterFile::Entry> entries;
    for (const auto &entry : parameters.entries)
      if (entry.first.rfind("Study/", 0) != 0 && entry.first.rfind("Sweeps/", 0) != 0 &&
          entry.first != "Output/Directory")
        entries.push_back(entry);
    return entries;
  }

  std::pair<std::vector<CaseRun>, std::vector<StudyRun>>
  study_runs(const std::string &file,
             const std::vector<std::string> &settings,
             const Parameters &parameters)
  {
    for (const Sweep &sweep : read_sweeps(parameters.sweeps))
      for (const Sweep::Choice &choice : sweep.choices)
        read_run(file, settings, choice.settings, "Sweeps/" + sweep.name + ", " + choice.label);
    std::vector<CaseRun> cases;
    std::vector<StudyRun> references;
    for (const StudyCase &study_case : study_cases(parameters))
    {
      CaseRun one;
      one.name       = study_case.name;
      one.labels     = study_case.labels;
      one.parameters = read_run(file, settings, study_case.settings, "Study, case " + one.name);
      if (!parameters.study.reference.empty())
      {
        if (one.parameters.loads.manufactured != "none")
          throw BadInput("Study/Reference = " + parameters.study.reference +
                         " is not needed with Loads/Manufactured solution = " +
                         one.parameters.loads.manufactured + "; remove one of the two.");
        const StudyRun reference =
          reference_of(study_case, parameters.study.reference, file, settings);
        while (one.reference < references.size() &&
               own_entries(references[one.reference].parameters) !=
                 own_entries(reference.parameters))
          ++one.reference;
        if (one.reference == references.size())
          references.push_back(reference);
      }
      cases.push_back(one);
    }
    std::stable_sort(cases.begin(), cases.end(), [](const CaseRun &one, const CaseRun &other) {
      return one.reference < other.reference;
    });
    return {cases, references};
  }

  double seconds_of(const ResultsRow &row)
  {
    const double errors = row.number("errors_s");
    return row.number("total_s") + (std::isnan(errors) ? 0 : errors);
  }

  void recall(StudyRun &run,
              const std::filesystem::path &folder,
              const unsigned int n_ranks,
              const std::string &reference)
  {
    std::vector<std::pair<std::string, std::string>> values;
    on_root(MPI_COMM_WORLD, [&] {
      auto origin = own_entries(run.parameters);
      origin.emplace_back("ranks", std::to_string(n_ranks)); // which times depend on
      origin.emplace_back("reference", reference);
      run.fingerprint = fingerprint(origin);
      if (folder.empty())
        return;
      const std::vector<ResultsRow> rows = read_results((folder / "results.csv").string());
      if (rows.size() != 1 || rows[0].get("fingerprint") != run.fingerprint)
        return;
      values               = rows[0].values();
      run.linear_residuals = read_linear_residuals((folder / "run.json").string());
    });
    for (const auto &[column, value] : dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, values))
      run.row.set(column, value);
  }

  std::string reason_of(const std::exception &error)
  {
    return dynamic_cast<const std::bad_alloc *>(&error) != nullptr
             ? "out of memory; use fewer cells or more machines"
             : error.what();
  }

  ResultsRow failed_row(const StudyRun &run, const std::string &reason)
  {
    const DiscretizationParameters &parameters = run.parameters.discretization;
    ResultsRow row;
    row.set("case", run.name);
    row.set("method", parameters.method);
    row.set("degree", parameters.degree);
    if (has_cut_levels(parameters.method))
      row.set("cut_levels", parameters.cut.levels);
    row.set("converged", false);
    row.set("failure", reason);
    return row;
  }

  void keep(const StudyRun &run, const std::filesystem::path &folder, RunRecord record)
  {
    record.status           = run.row.get("converged") == "true" ? "done" : "not converged";
    record.message          = run.row.get("failure");
    record.wall_s           = run.row.number("total_s");
    record.parameters       = own_entries(run.parameters);
    record.linear_residuals = {{run.name, run.linear_residuals}};
    on_root(MPI_COMM_WORLD, [&] {
      make_folder(folder.string());
      write_run_record((folder / "run.json").string(), record);
      write_results((folder / "results.csv").string(), {run.row}); // by which recall() knows it
    });
  }
} // namespace softcell
