// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the cases of a study one after the other.

#include <softcell/studies/study.h>

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/procedures/expected_memory.h>
#include <softcell/procedures/simulation.h>
#include <softcell/studies/bodies.h>
#include <softcell/studies/case_errors.h>
#include <softcell/studies/observed_rates.h>
#include <softcell/studies/study_run.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <tuple>

namespace softcell
{
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
        return cases_.size() == 1 && references_.empty();
      }

      /// Finds what is solved already.
      void resume();

      /// Builds every run that is to be solved, so that a mistake in the last one shows at once.
      void check();

      /// Solves all. @return 0, or 2 if a run did not converge.
      int run();

    private:
      std::filesystem::path folder_of(const StudyRun &run) const;
      /// @param reference whose displacement the run may impose.
      std::unique_ptr<Simulation>
      build(StudyRun &run, const std::string &what, const Simulation *reference = nullptr);
      /// From now on there is a folder. Collective.
      void begin();
      void solve_all();
      /// Makes reference_ that of the case, solved, or empty if it does not converge or fails.
      void provide_reference(const CaseRun &one);
      void solve_reference(unsigned int index);
      void warn_of_no_reference(const std::string &what);
      void solve_case(CaseRun &one, const std::string &what);
      void fail(CaseRun &one, const std::string &reason);
      void write_table();
      void write_record(const std::string &status, const std::string &message);
      void say_what_is_left();
      unsigned int n_failed() const;
      /// Is the reference still to be solved, for a case that is?
      bool is_needed(unsigned int reference) const;

      Console &console_;
      Parameters parameters_;
      std::vector<CaseRun> cases_; // those of the same reference together
      std::vector<StudyRun> references_;
      std::filesystem::path folder_;
      Bodies bodies_;
      std::unique_ptr<Simulation> reference_;
      unsigned int reference_index_ = dealii::numbers::invalid_unsigned_int; // of reference_
      bool has_folder_              = false;
      TimeLeft time_left_;
      RunRecord record_;
      Timers timers_;
    };

    bool is_thrown_on_all(const std::exception &error)
    {
      return dynamic_cast<const BadInput *>(&error) != nullptr ||
             dynamic_cast<const NotConverged *>(&error) != nullptr ||
             dynamic_cast<const InvertedPoint *>(&error) != nullptr ||
             dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
    }

    Study::Study(const std::string &file,
                 const std::vector<std::string> &settings,
                 const std::vector<std::string> &command_line,
                 Console &console)
        : console_(console), parameters_(read_parameters(file, settings))
    {
      std::tie(cases_, references_) = study_runs(file, settings, parameters_);
      folder_                       = parameters_.output.directory.empty()
                                        ? std::filesystem::path("runs") / std::filesystem::path(file).stem()
                                        : std::filesystem::path(parameters_.output.directory);
      record_.command_line          = "softcell";
      for (const std::string &word : command_line)
        record_.command_line +=
          word.find(' ') == std::string::npos ? ' ' + word : " '" + word + "'";
      record_.ranks      = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      record_.parameters = parameters_.entries;
    }

    std::filesystem::path Study::folder_of(const StudyRun &run) const
    {
      return cases_.size() == 1 && &run == &cases_[0] ? folder_ : folder_ / run.name;
    }

    std::unique_ptr<Simulation>
    Study::build(StudyRun &run, const std::string &what, const Simulation *const reference)
    {
      std::optional<DisplacementField> field;
      if (reference)
        field.emplace(reference->field());
      const Body &body = bodies_.get(run.parameters, console_, record_.remarks);
      console_.say(what + run.name);
      std::unique_ptr<Simulation> simulation;
      try
      {
        simulation = std::make_unique<Simulation>(run.name, run.parameters, body, console_,
                                                  field ? &*field : nullptr);
      }
      catch (const BadInput &error)
      {
        throw BadInput((has_one_run() ? "" : run.name + ": ") + error.what());
      }
      const Size size = simulation->discretization().size();
      run.work        = work_of(run.parameters, static_cast<double>(size.integration_points),
                                static_cast<double>(size.unknowns));
      return simulation;
    }

    void Study::resume()
    {
      const auto find = [&](StudyRun &run, const std::string &reference, const char *const file) {
        const std::filesystem::path folder = folder_of(run);
        std::error_code error;
        // a case without a folder of its own is always solved
        const bool is_there = parameters_.study.resume && folder != folder_ &&
                              std::filesystem::exists(folder / file, error);
        recall(run, is_there ? folder : "", record_.ranks, reference);
        if (run.is_solved())
          time_left_.add(
            work_of(run.parameters, run.row.number("integration_points"), run.row.number("dofs")),
            seconds_of(run.row));
      };
      for (StudyRun &reference : references_)
        find(reference, "", "checkpoint.h5");
      for (CaseRun &one : cases_)
        find(one, references_.empty() ? "" : references_[one.reference].fingerprint, "results.csv");
      if (const auto n = std::count_if(cases_.begin(), cases_.end(),
                                       [](const CaseRun &one) { return one.is_solved(); });
          n > 0)
        console_.say("Solved before with the same parameters and program: " + std::to_string(n) +
                     " of " + std::to_string(cases_.size()) +
                     " cases; 'Study/Resume = false' solves them again.");
    }

    void Study::check()
    {
      on_root(MPI_COMM_WORLD, [&] { check_folder(folder_.string()); });
      for (const CaseRun &one : cases_)
        if (!one.is_solved())
          check_memory(one.parameters, bodies_.get(one.parameters, console_, record_.remarks),
                       MPI_COMM_WORLD);
      for (unsigned int i = references_.size(); i-- > 0;) // the first one stays, it is next
        if (is_needed(i))
        {
          reference_       = build(references_[i], "Check of ");
          reference_index_ = i;
        }
      for (unsigned int i = 0; i < cases_.size(); ++i)
      {
        CaseRun &one             = cases_[i];
        const bool has_reference = reference_ && reference_index_ == one.reference;
        if (!one.is_solved() && (has_reference || !imposes_reference(one.parameters)))
          build(one,
                "Check of case " + std::to_string(i + 1) + " of " + std::to_string(cases_.size()) +
                  ": ",
                has_reference ? reference_.get() : nullptr);
      }
    }

    void Study::begin()
    {
      if (has_folder_)
        return;
      has_folder_ = true;
      write_record("running", "");
      on_root(MPI_COMM_WORLD, [&] {
        std::error_code error; // an old table would be taken for this run's
        std::filesystem::remove(folder_ / "results.csv", error);
      });
      write_table();
    }

    void Study::write_table()
    {
      on_root(MPI_COMM_WORLD, [&] {
        std::vector<ResultsRow> rows;
        std::vector<std::string> sweeps;
        for (const CaseRun &one : cases_)
          if (one.is_solved())
            rows.push_back(one.row);
        for (const auto &[name, label] : cases_[0].labels)
          sweeps.push_back(name);
        add_observed_rates(rows, sweeps);
        if (!rows.empty())
          write_results((folder_ / "results.csv").string(), rows);
      });
    }

    void Study::write_record(const std::string &status, const std::string &message)
    {
      record_.status  = status;
      record_.message = message;
      record_.wall_s  = timers_.total();
      record_.linear_residuals.clear();
      for (const CaseRun &one : cases_)
        if (one.is_solved())
          record_.linear_residuals.emplace_back(one.name, one.linear_residuals);
      on_root(MPI_COMM_WORLD, [&] {
        make_folder(folder_.string());
        write_run_record((folder_ / "run.json").string(), record_);
      });
    }

    bool Study::is_needed(const unsigned int reference) const
    {
      return !references_[reference].is_solved() &&
             std::any_of(cases_.begin(), cases_.end(), [&](const CaseRun &one) {
               return one.reference == reference && !one.is_solved();
             });
    }

    unsigned int Study::n_failed() const
    {
      const auto has_failed = [](const StudyRun &run) {
        return run.row.get("converged") == "false";
      };
      return std::count_if(cases_.begin(), cases_.end(), has_failed) +
             std::count_if(references_.begin(), references_.end(), has_failed);
    }

    int Study::run()
    {
      try
      {
        solve_all();
      }
      catch (const std::exception &error)
      {
        if (has_folder_ && is_thrown_on_all(error))
          write_record("failed", error.what());
        else if (has_folder_) // perhaps on this rank alone, so that nothing collective can be done
        {
          record_.status  = "failed";
          record_.message = error.what();
          write_failure((folder_ / "run.json").string(), record_);
        }
        throw;
      }
      const unsigned int n = n_failed();
      write_record(n == 0 ? "done" : "not converged",
                   n == 0 ? ""
                          : std::to_string(n) + " of " +
                              std::to_string(cases_.size() + references_.size()) +
                              " runs did not converge");
      console_.say("Results: " + (folder_ / "results.csv").string());
      return n == 0 ? 0 : 2;
    }

    void Study::solve_all()
    {
      if (!has_one_run()) // else only once it is built: a mistake leaves no folder behind
        begin();
      for (unsigned int i = 0; i < cases_.size(); ++i)
        if (CaseRun &one = cases_[i]; !one.is_solved())
        {
          const std::string what =
            "Case " + std::to_string(i + 1) + " of " + std::to_string(cases_.size()) + ": ";
          try
          {
            if (!references_.empty())
              provide_reference(one);
            solve_case(one, what);
          }
          catch (const std::exception &error)
          {
            if (has_one_run() || !is_thrown_on_all(error))
              throw; // the other ranks may be waiting for this one
            fail(one, reason_of(error));
          }
          say_what_is_left();
        }
    }

    void Study::provide_reference(const CaseRun &one)
    {
      StudyRun &run = references_[one.reference];
      if (reference_index_ != one.reference)
        reference_.reset(); // before the next one needs memory
      try
      {
        if (!run.is_solved())
          solve_reference(one.reference);
        else if (reference_index_ != one.reference && run.row.get("converged") != "false")
        {
          StudyRun again                          = run;
          again.parameters.procedure.start_from   = (folder_of(run) / "checkpoint.h5").string();
          again.parameters.procedure.coarse_grids = 0;
          reference_                              = build(again, "Solved before: ");
          reference_index_                        = one.reference;
        }
      }
      catch (const std::exception &error)
      {
        if (!is_thrown_on_all(error))
          throw;
        run.row = failed_row(run, reason_of(error));
        warn_of_no_reference("The reference failed: " + reason_of(error));
      }
      if (run.row.get("converged") == "false" && imposes_reference(one.parameters))
        throw BadInput("It imposes the displacement of the reference, which is not there: " +
                       run.row.get("failure"));
    }

    void Study::warn_of_no_reference(const std::string &what)
    {
      record_.remarks.push_back(what);
      console_.warn(what + " Its cases get no errors.");
    }

    void Study::solve_reference(const unsigned int index)
    {
      StudyRun &run                         = references_[index];
      const std::filesystem::path folder    = folder_of(run);
      std::unique_ptr<Simulation> reference = std::move(reference_); // until it is solved
      if (!reference)
        reference = build(run, "");
      console_.say("Reference: " + parameters_.study.reference);
      const bool is_solved = reference->solve(folder);
      run.row              = reference->row();
      run.linear_residuals = reference->linear_residuals();
      run.row.set("fingerprint", run.fingerprint);
      reference->write(folder);
      reference_index_ = index;
      if (is_solved)
        reference_ = std::move(reference);
      else
      {
        run.row.set("failure", reference->reason());
        warn_of_no_reference("The reference did not converge: " + reference->reason() + ".");
      }
      time_left_.add(run.work, seconds_of(run.row));
      keep(run, folder, record_);
    }

    void Study::solve_case(CaseRun &one, const std::string &what)
    {
      const auto simulation = build(one, what, reference_.get());
      begin();
      const std::filesystem::path folder = folder_of(one);
      const bool is_solved               = simulation->solve(folder);
      ResultsRow row                     = simulation->row();
      if (is_solved && (reference_ || simulation->exact()))
        if (const std::string warning = add_errors(*simulation, reference_.get(), row);
            !warning.empty())
        {
          console_.warn(one.name + ": " + warning);
          record_.remarks.push_back(one.name + ": " + warning);
        }
      for (const auto &[name, label] : one.labels)
        row.set(name, label);
      for (const std::string &remark : simulation->remarks())
        record_.remarks.push_back(row.get("case") + ": " + remark);
      if (!is_solved)
      {
        console_.warn("Not converged: " + simulation->reason() + ".");
        row.set("failure", simulation->reason());
      }
      // a reference that failed is tried again, and with it its cases
      if (references_.empty() || !references_[one.reference].row.get("fingerprint").empty())
        row.set("fingerprint", one.fingerprint);
      one.row              = row;
      one.linear_residuals = simulation->linear_residuals();
      time_left_.add(one.work, seconds_of(row));
      write_table();
      simulation->write(folder);
      if (folder == folder_)
        return;
      keep(one, folder, record_);
      write_record("running", "");
    }

    void Study::fail(CaseRun &one, const std::string &reason)
    {
      console_.warn("Failed: " + reason);
      one.row = failed_row(one, reason);
      for (const auto &[name, label] : one.labels)
        one.row.set(name, label);
      write_table();
    }

    void Study::say_what_is_left()
    {
      double seconds     = 0;
      unsigned int n     = 0;
      const auto add_run = [&](const StudyRun &run) {
        if (run.is_solved())
          return;
        ++n;
        seconds += time_left_.guess(run.work);
      };
      std::for_each(cases_.begin(), cases_.end(), add_run);
      for (unsigned int i = 0; i < references_.size(); ++i)
        if (is_needed(i))
          add_run(references_[i]);
      if (n > 0 && std::isfinite(seconds))
        console_.say("  " + std::to_string(n) + (n == 1 ? " run" : " runs") + " left, about " +
                     duration(seconds));
    }
  } // namespace

  int run_study(const std::string &file,
                const std::vector<std::string> &settings,
                const std::vector<std::string> &command_line,
                const bool is_check,
                Console &console)
  {
    Study study(file, settings, command_line, console);
    if (!is_check)
      study.resume();
    if (is_check || !study.has_one_run())
      study.check();
    return is_check ? 0 : study.run();
  }
} // namespace softcell
