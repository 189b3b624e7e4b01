// SPDX-License-Identifier: LGPL-2.1-or-later
// Leaves runs in their folders and finds them again.

#include <softcell/studies/study_run.h>

#include <softcell/base/collective.h>
#include <softcell/base/files.h>
#include <softcell/output/fingerprint.h>

#include <deal.II/base/mpi.h>

#include <boost/serialization/utility.hpp>

namespace softcell
{
  std::vector<ParameterFile::Entry> own_entries(const Parameters &parameters)
  {
    std::vector<ParameterFile::Entry> entries;
    for (const auto &entry : parameters.entries)
      if (entry.first.rfind("Study/", 0) != 0 && entry.first.rfind("Sweeps/", 0) != 0 &&
          entry.first != "Output/Directory")
        entries.push_back(entry);
    return entries;
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
