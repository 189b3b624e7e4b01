// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run tells its user while it works, and where its time and memory go.
#pragma once

#include <mpi.h>

#include <chrono>
#include <ostream>
#include <string>
#include <vector>

namespace softcell
{
  /// The text as a terminal can show it: `?` for bytes that are no printable character of UTF-8,
  /// and dots for the middle of what is longer than 1000 bytes.
  std::string printable(const std::string &text);

  /// Lines for the user; only rank 0 writes.
  class Console
  {
  public:
    /// Writes to standard output, or nothing but warnings if quiet.
    explicit Console(MPI_Comm communicator, bool quiet = false);

    /// Writes to `out`.
    /// @param is_live   `out` is a terminal on which a line can be rewritten.
    /// @param interval  between progress lines where it is not. Units: s
    Console(std::ostream &out, bool is_live, double interval);
    ~Console();

    Console(const Console &)            = delete;
    Console &operator=(const Console &) = delete;

    /// A line that stays.
    void say(const std::string &line);

    /// A line that stays and is seen even by those who asked for quiet.
    void warn(const std::string &line);

    /// How far a long piece of work has come: rewrites one line on a terminal; in a log a line
    /// every few seconds.
    void progress(const std::string &line);

  private:
    using Clock = std::chrono::steady_clock;

    void erase_progress();

    std::ostream *out_ = nullptr; // null: this rank does not write, or is quiet
    bool is_root_      = true;
    bool is_live_      = false;
    bool is_shown_     = false; // a progress line stands on the terminal
    double interval_   = 5;
    Clock::time_point last_progress_;
  };

  /// Wall time by named section on this rank.
  class Timers
  {
  public:
    /// Adds the time of its life to a section.
    class Scope
    {
    public:
      Scope(Timers &timers, std::string name);
      ~Scope();
      Scope(const Scope &)            = delete;
      Scope &operator=(const Scope &) = delete;

    private:
      Timers &timers_;
      std::string name_;
      std::chrono::steady_clock::time_point start_;
    };

    void add(const std::string &name, double seconds);

    /// Seconds spent in a section, 0 if it never ran.
    double seconds(const std::string &name) const;
    /// Seconds of one run of the section in the mean, 0 if it never ran.
    double mean(const std::string &name) const;
    /// Seconds since this object was made.
    double total() const;

    /// A line per section: seconds, share of the total, runs.
    void print(Console &console) const;

  private:
    struct Section
    {
      std::string name;
      double seconds    = 0;
      unsigned int runs = 0;
    };
    const Section *find(const std::string &name) const;

    std::vector<Section> sections_; // in the order of their first end
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  /// The largest memory that any rank's process has held so far. Collective. Units: MiB
  double peak_rss_mib(MPI_Comm communicator);
} // namespace softcell
