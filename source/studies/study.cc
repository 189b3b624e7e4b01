// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the cases of a study one after the other.

#include <softcell/studies/study.h>

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/output/results.h>
#include <softcell/output/run_record.h>
#include <softcell/procedures/expected_memory.h>
#include <softcell/procedures/simulation.h>
#include <softcell/studies/difference.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
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

  } // namespace

  std::vector<StudyCase> study_cases(const Parameters &parameters)
  {
    const StudyParameters &study = parameters.study;
    if (!study.cells.empty() && !parameters.discretization.mesh.file.empty())
      throw BadInput("Study/Cells = " + study.cells + " changes nothing about the mesh of " +
                     "Discretization/Mesh file = " + parameters.discretization.mesh.file +
                     "; remove one of the two.");
    std::vector<StudyCase> cases;
    for (const std::string &item : list_or_blank(study.methods))
    {
      const auto [named_method, own_degree] = method_and_degree(item);
      const std::string method = item.empty() ? parameters.discretization.method : named_method;
      const auto degrees =
        own_degree.empty() ? numbers(study.degrees) : std::vector<std::string>{own_degree};
      const auto levels =
        has_cut_levels(method) ? numbers(study.cut_levels) : std::vector<std::string>{""};
      for (const std::string &degree : degrees)
        for (const std::string &cells : numbers(study.cells))
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
            if (!cells.empty()) // which an edge length would win over
              set(method == "tetrahedra" ? "Mesh size" : "Cell size", "0", "");
            set("Cut levels", level, " l" + level);
            std::replace(one.name.begin(), one.name.end(), ' ', '_');
            cases.push_back(one);
          }
    }
    const auto has_levels = [](const StudyCase &one) {
      return one.settings.size() > 0 &&
             one.settings.back().find("/Cut levels") != std::string::npos;
    };
    if (!study.cut_levels.empty() && std::none_of(cases.begin(), cases.end(), has_levels))
      throw BadInput("Study/Cut levels = " + study.cut_levels +
                     " means nothing to any of the methods; remove it.");
    for (std::size_t i = 0; i < cases.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (cases[i].name == cases[k].name)
          throw BadInput("Study asks for the case " + cases[i].name +
                         " twice; remove one from its lists.");
    return cases;
  }

  namespace
  {
    /// The cases of a parameter file and what they have in common.
    class Study
    {
    public:
      Study(const std::string &file,
            const std::vector<std::string> &settings,
            const std::vector<std::string> &command_line,
            Console &console);

      bool has_one_run() const
      {
        return cases_.size() == 1 && !reference_parameters_;
      }

      /// Builds every run, so that a mistake in the last one shows at once; the reference stays.
      void check();

      /// Solves all. @return 0, or 2 if a case did not converge.
      int run();

    private:
      std::unique_ptr<Simulation> build_reference() const;
      std::unique_ptr<Simulation> build_case(unsigned int i, const std::string &what) const;
      void solve_reference();
      /// Solves, writes and returns whether it converged.
      bool solve_case(unsigned int i, Simulation &simulation);
      void solve_all();
      /// Adds the difference to the reference to a row, and the rate at which it fell since the
      /// last row of the same method, degree and levels.
      void add_errors(const Simulation &simulation, ResultsRow &row);
      void say_what_is_left(unsigned int n_done) const;
      /// From now on there is a folder. Collective.
      void begin();
      void write_record(const std::string &status, const std::string &message);

      Console &console_;
      Parameters parameters_;
      std::vector<StudyCase> cases_;
      std::vector<Parameters> case_parameters_;
      std::optional<Parameters> reference_parameters_;
      std::filesystem::path folder_;
      std::unique_ptr<Body> body_;
      std::unique_ptr<Simulation> reference_;
      std::unique_ptr<ResultsTable> table_; // once there is a folder
      std::map<std::string, ResultsRow> last_of_series_;
      unsigned int n_failed_ = 0;
      RunRecord record_;
      Timers timers_;
    };

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

    Study::Study(const std::string &file,
                 const std::vector<std::string> &settings,
                 const std::vector<std::string> &command_line,
                 Console &console)
        : console_(console),
          parameters_(read_parameters(file, settings)),
          cases_(study_cases(parameters_))
    {
      for (const StudyCase &one : cases_)
        case_parameters_.push_back(read_run(file, settings, one.settings, "Study"));
      if (const std::string &reference = parameters_.study.reference; !reference.empty())
        reference_parameters_ = read_run(file, settings, list(reference, ';'), "Study/Reference");

      folder_              = parameters_.output.directory.empty()
                               ? std::filesystem::path("runs") / std::filesystem::path(file).stem()
                               : std::filesystem::path(parameters_.output.directory);
      record_.command_line = "softcell";
      for (const std::string &word : command_line)
        record_.command_line +=
          word.find(' ') == std::string::npos ? ' ' + word : " '" + word + "'";
      record_.ranks      = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      record_.parameters = parameters_.entries;

      // A file may be missing on some ranks' machines only.
      on_all(MPI_COMM_WORLD, [&] { body_ = make_body(parameters_.geometry, record_.remarks); });
      const auto [lower, upper] = body_->bounding_box().get_boundary_points();
      std::ostringstream text;
      text.precision(4);
      text << "Body: " << parameters_.geometry.type << ", " << body_->volume() << " m^3 between ("
           << lower << ") and (" << upper << ") m";
      console_.say(text.str());
      for (const std::string &remark : record_.remarks)
        console_.say("  " + remark);
    }

    std::unique_ptr<Simulation> Study::build_reference() const
    {
      console_.say("Reference: " + parameters_.study.reference);
      return std::make_unique<Simulation>("reference", *reference_parameters_, *body_, console_);
    }

    std::unique_ptr<Simulation> Study::build_case(const unsigned int i,
                                                  const std::string &what) const
    {
      console_.say(what + ' ' + std::to_string(i + 1) + " of " + std::to_string(cases_.size()) +
                   ": " + cases_[i].name);
      return std::make_unique<Simulation>(cases_[i].name, case_parameters_[i], *body_, console_);
    }

    void Study::check()
    {
      on_root(MPI_COMM_WORLD, [&] { check_folder(folder_.string()); });
      for (const Parameters &parameters : case_parameters_)
        check_memory(parameters, *body_, MPI_COMM_WORLD);
      if (reference_parameters_)
        reference_ = build_reference();
      for (unsigned int i = 0; i < cases_.size(); ++i)
        build_case(i, "Check of case");
    }

    void Study::begin()
    {
      write_record("running", "");
      const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
      table_ = std::make_unique<ResultsTable>(is_root ? (folder_ / "results.csv").string() : "");
    }

    void Study::write_record(const std::string &status, const std::string &message)
    {
      record_.status  = status;
      record_.message = message;
      record_.wall_s  = timers_.total();
      on_root(MPI_COMM_WORLD, [&] {
        make_folder(folder_.string());
        write_run_record((folder_ / "run.json").string(), record_);
      });
    }

    int Study::run()
    {
      try
      {
        solve_all();
      }
      catch (const BadInput &error)
      {
        if (table_)
          write_record("failed", error.what());
        throw;
      }
      catch (const NotConverged &error)
      {
        write_record("not converged", error.what());
        throw;
      }
      catch (const std::exception &error)
      {
        // Perhaps on this rank alone, so that nothing collective can be done.
        record_.status  = "failed";
        record_.message = error.what();
        if (table_)
          write_run_record((folder_ / "run.json").string(), record_);
        throw;
      }
      write_record(n_failed_ == 0 ? "done" : "not converged",
                   n_failed_ == 0 ? ""
                                  : std::to_string(n_failed_) + " of " +
                                      std::to_string(cases_.size()) + " cases did not converge");
      console_.say("Results: " + (folder_ / "results.csv").string());
      return n_failed_ == 0 ? 0 : 2;
    }

    void Study::solve_all()
    {
      if (reference_parameters_)
        solve_reference();
      for (unsigned int i = 0; i < cases_.size(); ++i)
      {
        const auto simulation = build_case(i, "Case");
        if (!table_) // only now: a mistake while the only case is built leaves no folder behind
          begin();
        n_failed_ += !solve_case(i, *simulation);
        say_what_is_left(i + 1);
      }
    }

    void Study::solve_reference()
    {
      begin();
      if (reference_->solve(folder_ / "reference"))
        return;
      reference_->write(folder_ / "reference");
      throw NotConverged("The reference did not converge: " + reference_->reason() + ".");
    }

    bool Study::solve_case(const unsigned int i, Simulation &simulation)
    {
      const std::filesystem::path folder = cases_.size() == 1 ? folder_ : folder_ / cases_[i].name;
      const bool is_solved               = simulation.solve(folder);
      if (!is_solved)
        console_.warn("Not converged: " + simulation.reason() + ".");
      ResultsRow row = simulation.row();
      if (reference_)
        add_errors(simulation, row);
      on_root(MPI_COMM_WORLD, [&] { table_->add(row); });
      record_.linear_residuals.emplace_back(cases_[i].name, simulation.linear_residuals());
      simulation.write(folder);
      return is_solved;
    }

    void Study::add_errors(const Simulation &simulation, ResultsRow &row)
    {
      const Difference error =
        difference(simulation.discretization(), simulation.displacement(),
                   reference_->discretization(), reference_->displacement(), simulation.reach());
      row.set("relative_l2_error", error.relative_l2);
      row.set("relative_h1_error", error.relative_h1);
      if (error.missed > 0)
      {
        std::ostringstream text;
        text.precision(2);
        text << row.get("case") << ": the errors leave out " << 100 * error.missed
             << " % of the reference's volume, which no cell is near; give more cells.";
        console_.warn(text.str());
        record_.remarks.push_back(text.str());
      }

      ResultsRow &last =
        last_of_series_[row.get("method") + row.get("degree") + '/' + row.get("cut_levels")];
      const double refinement = last.number("cell_size") / row.number("cell_size");
      if (refinement > 1)
        row.set("observed_rate", std::log(last.number("relative_l2_error") / error.relative_l2) /
                                   std::log(refinement));
      last = row;
    }

    void Study::say_what_is_left(const unsigned int n_done) const
    {
      if (n_done == cases_.size())
        return;
      std::ostringstream text;
      text.precision(0);
      text << std::fixed << "  about " << timers_.total() / n_done * (cases_.size() - n_done)
           << " s left if the other cases take as long";
      console_.say(text.str());
    }
  } // namespace

  int run_study(const std::string &file,
                const std::vector<std::string> &settings,
                const std::vector<std::string> &command_line,
                const bool is_check,
                Console &console)
  {
    Study study(file, settings, command_line, console);
    if (is_check || !study.has_one_run())
      study.check();
    return is_check ? 0 : study.run();
  }
} // namespace softcell
