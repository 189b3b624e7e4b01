// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the cases of a study one after the other.

#include <softcell/studies/study.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/output/results.h>
#include <softcell/output/run_record.h>
#include <softcell/procedures/simulation.h>
#include <softcell/studies/difference.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace softcell
{
  namespace
  {
    std::vector<std::string> list(const std::string &text, const char separator = ',')
    {
      std::vector<std::string> items = dealii::Utilities::split_string_list(text, separator);
      items.erase(std::remove(items.begin(), items.end(), ""), items.end());
      return items;
    }

    /// The items, or one empty item if there are none, so that a loop runs once and sets nothing.
    std::vector<std::string> list_or_blank(const std::string &text)
    {
      const std::vector<std::string> items = list(text);
      return items.empty() ? std::vector<std::string>{""} : items;
    }

    /// `tetrahedra 2` as method and degree; an empty degree if none is given.
    std::pair<std::string, std::string> method_and_degree(const std::string &text)
    {
      const std::size_t end = text.find_last_not_of("0123456789");
      if (end == std::string::npos || end + 1 == text.size())
        return {text, ""};
      return {dealii::Utilities::trim(text.substr(0, end + 1)), text.substr(end + 1)};
    }

    /// Adds the difference to the reference to a row, and the rate at which it fell since the last
    /// row of the same method, degree and levels.
    void add_errors(const Simulation &reference,
                    const Simulation &simulation,
                    std::map<std::string, ResultsRow> &last_of_series,
                    ResultsRow &row)
    {
      const Difference error =
        difference(simulation.discretization(), simulation.displacement(),
                   reference.discretization(), reference.displacement(), simulation.reach());
      row.set("relative_l2_error", error.relative_l2);
      row.set("relative_h1_error", error.relative_h1);

      ResultsRow &last =
        last_of_series[row.get("method") + row.get("degree") + '/' + row.get("cut_levels")];
      const double refinement = last.number("cell_size") / row.number("cell_size");
      if (refinement > 1)
        row.set("observed_rate", std::log(last.number("relative_l2_error") / error.relative_l2) /
                                   std::log(refinement));
      last = row;
    }
  } // namespace

  std::vector<StudyCase> study_cases(const Parameters &parameters)
  {
    const StudyParameters &study = parameters.study;
    std::vector<StudyCase> cases;
    for (const std::string &item : list_or_blank(study.methods))
    {
      const auto [named_method, own_degree] = method_and_degree(item);
      const std::string method = item.empty() ? parameters.discretization.method : named_method;
      const auto degrees =
        own_degree.empty() ? list_or_blank(study.degrees) : std::vector<std::string>{own_degree};
      const auto levels =
        has_cut_levels(method) ? list_or_blank(study.cut_levels) : std::vector<std::string>{""};
      for (const std::string &degree : degrees)
        for (const std::string &cells : list_or_blank(study.cells))
          for (const std::string &level : levels)
          {
            StudyCase one{method, {}};
            const auto set = [&](const std::string &entry, const std::string &value,
                                 const std::string &tag) {
              if (value.empty())
                return;
              one.settings.push_back("Discretization/" + entry + " = " + value);
              one.name += tag;
            };
            set("Method", item.empty() ? "" : method, "");
            set("Degree", degree, " p" + degree);
            set("Cells", cells, " n" + cells);
            if (method == "tetrahedra" && !cells.empty())
              set("Mesh size", "0", ""); // it would win over Cells
            set("Cut levels", level, " l" + level);
            std::replace(one.name.begin(), one.name.end(), ' ', '_');
            cases.push_back(one);
          }
    }
    return cases;
  }

  int run_study(const std::string &file,
                const std::vector<std::string> &settings,
                const std::vector<std::string> &command_line,
                const bool is_check,
                Console &console)
  {
    const auto with = [&](const std::vector<std::string> &more) {
      std::vector<std::string> all = settings;
      all.insert(all.end(), more.begin(), more.end());
      return all;
    };
    const Parameters parameters        = read_parameters(file, settings);
    const std::vector<StudyCase> cases = study_cases(parameters);

    // Every case is read before the first is solved: a mistake in the last one shows at once.
    std::vector<Parameters> case_parameters;
    for (const StudyCase &one : cases)
      case_parameters.push_back(read_parameters(file, with(one.settings)));

    const std::filesystem::path folder =
      parameters.output.directory.empty()
        ? std::filesystem::path("runs") / std::filesystem::path(file).stem()
        : std::filesystem::path(parameters.output.directory);
    const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;

    RunRecord record;
    record.command_line = "softcell";
    for (const std::string &word : command_line)
      record.command_line += ' ' + word;
    record.ranks      = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    record.parameters = parameters.entries;

    Timers timers;
    const auto write_record = [&] {
      record.wall_s = timers.total();
      on_root(MPI_COMM_WORLD, [&] {
        make_folder(folder.string());
        write_run_record((folder / "run.json").string(), record);
      });
    };
    console.say("Body: " + parameters.geometry.type + ' ' + parameters.geometry.file);
    const std::unique_ptr<Body> body = make_body(parameters.geometry, record.remarks);
    for (const std::string &remark : record.remarks)
      console.say("  " + remark);

    std::unique_ptr<Simulation> reference;
    if (!parameters.study.reference.empty())
    {
      console.say("Reference: " + parameters.study.reference);
      const Parameters settings_of_reference =
        read_parameters(file, with(list(parameters.study.reference, ';')));
      reference = std::make_unique<Simulation>("reference", settings_of_reference, *body, console);
      if (!is_check && !reference->solve())
      {
        record.status  = "not converged";
        record.message = "The reference did not converge: " + reference->reason() + ".";
        write_record();
        reference->write(folder / "reference");
        throw NotConverged(record.message);
      }
    }

    std::unique_ptr<ResultsTable> table;
    std::map<std::string, ResultsRow> last_of_series;
    unsigned int n_failed = 0;
    for (unsigned int i = 0; i < cases.size(); ++i)
    {
      console.say("Case " + std::to_string(i + 1) + " of " + std::to_string(cases.size()) + ": " +
                  cases[i].name);
      Simulation simulation(cases[i].name, case_parameters[i], *body, console);
      if (is_check)
        continue;
      if (!table)
      {
        // Only now: a mistake that shows while the first case is built leaves no folder behind.
        write_record();
        table = std::make_unique<ResultsTable>(is_root ? (folder / "results.csv").string() : "");
      }
      if (!simulation.solve())
      {
        console.warn("Not converged: " + simulation.reason() + ".");
        ++n_failed;
      }
      ResultsRow row = simulation.row();
      if (reference)
        add_errors(*reference, simulation, last_of_series, row);
      on_root(MPI_COMM_WORLD, [&] { table->add(row); });
      simulation.write(cases.size() == 1 ? folder : folder / cases[i].name);
      if (i + 1 < cases.size())
      {
        const double left = timers.total() / (i + 1) * (cases.size() - i - 1);
        std::ostringstream text;
        text.precision(0);
        text << std::fixed << "  about " << left << " s left if the other cases take as long";
        console.say(text.str());
      }
    }
    if (is_check)
      return 0;

    record.status  = n_failed == 0 ? "done" : "not converged";
    record.message = n_failed == 0 ? "" : std::to_string(n_failed) + " cases did not converge";
    write_record();
    console.say("Results: " + (folder / "results.csv").string());
    return n_failed == 0 ? 0 : 2;
  }
} // namespace softcell
