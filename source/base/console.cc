// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run tells its user while it works, and where its time and memory go.

#include <softcell/base/console.h>

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace softcell
{
  namespace
  {
    double seconds_since(const std::chrono::steady_clock::time_point start)
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    std::size_t terminal_width()
    {
      winsize size{};
      return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    }
  } // namespace

  std::string printable(const std::string &text)
  {
    constexpr std::size_t longest = 1000, end = 300;
    if (text.size() > longest)
      return printable(text.substr(0, longest - end)) + " ... " +
             printable(text.substr(text.size() - end));
    std::string result;
    for (std::size_t i = 0; i < text.size();)
    {
      const unsigned char c = text[i];
      std::size_t length    = c < 0xc2 ? 1 : c < 0xe0 ? 2 : c < 0xf0 ? 3 : 4;
      const std::string one = text.substr(i, length);
      const bool is_whole   = one.size() == length &&
                            std::all_of(one.begin() + 1, one.end(),
                                        [](const unsigned char next) { return next >> 6 == 2; });
      const bool is_shown = c < 0x80 ? c >= 32 && c != 127 : c >= 0xc2 && c < 0xf5 && is_whole;
      result += is_shown ? one : "?";
      i += is_shown ? length : 1;
    }
    return result;
  }

  Console::Console(MPI_Comm communicator, const bool quiet)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    is_root_ = rank == 0;
    if (is_root_ && !quiet)
    {
      out_ = &std::cout;
      // mpirun gives its ranks a terminal to write to even where its own output goes to a file
      is_live_ = isatty(STDOUT_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
    }
  }

  Console::Console(std::ostream &out, const bool is_live, const double interval)
      : out_(&out), is_live_(is_live), interval_(interval)
  {
  }

  Console::~Console()
  {
    erase_progress();
  }

  void Console::say(const std::string &line)
  {
    erase_progress();
    if (out_ != nullptr)
      *out_ << line << std::endl;
  }

  void Console::warn(const std::string &line)
  {
    erase_progress();
    if (is_root_)
      (out_ != nullptr ? *out_ : std::cerr) << "warning: " << printable(line) << std::endl;
  }

  void Console::progress(const std::string &line)
  {
    if (out_ == nullptr)
      return;
    if (is_live_)
    {
      *out_ << "\r\033[K" << line.substr(0, terminal_width() - 1) << std::flush;
      is_shown_ = true;
    }
    else if (last_progress_ == Clock::time_point() || seconds_since(last_progress_) >= interval_)
    {
      *out_ << line << std::endl;
      last_progress_ = Clock::now();
    }
  }

  void Console::erase_progress()
  {
    if (is_shown_)
      *out_ << "\r\033[K" << std::flush;
    is_shown_ = false;
  }

  Timers::Scope::Scope(Timers &timers, std::string name)
      : timers_(timers), name_(std::move(name)), start_(std::chrono::steady_clock::now())
  {
  }

  Timers::Scope::~Scope()
  {
    timers_.add(name_, seconds_since(start_));
  }

  void Timers::add(const std::string &name, const double seconds)
  {
    if (find(name) == nullptr)
      sections_.push_back({name, 0, 0});
    Section &section = const_cast<Section &>(*find(name));
    section.seconds += seconds;
    ++section.runs;
  }

  double Timers::seconds(const std::string &name) const
  {
    const Section *section = find(name);
    return section == nullptr ? 0 : section->seconds;
  }

  double Timers::mean(const std::string &name) const
  {
    const Section *section = find(name);
    return section == nullptr ? 0 : section->seconds / section->runs;
  }

  double Timers::total() const
  {
    return seconds_since(start_);
  }

  void Timers::print(Console &console) const
  {
    const double all = total();
    const auto line  = [&](const std::string &name, const double seconds, const std::string &runs) {
      char text[120];
      std::snprintf(text, sizeof(text), "  %-24.60s %9.3f s %5.1f %% %8s", name.c_str(), seconds,
                    all > 0 ? 100 * seconds / all : 0., runs.c_str());
      console.say(text);
    };
    for (const Section &section : sections_)
      line(section.name, section.seconds, std::to_string(section.runs) + " x");
    line("in all", all, "");
  }

  const Timers::Section *Timers::find(const std::string &name) const
  {
    const auto section = std::find_if(sections_.begin(), sections_.end(),
                                      [&](const Section &s) { return s.name == name; });
    return section == sections_.end() ? nullptr : &*section;
  }

  double peak_rss_mib(MPI_Comm communicator)
  {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    double mib = usage.ru_maxrss / 1024.; // Linux counts KiB
    MPI_Allreduce(MPI_IN_PLACE, &mib, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return mib;
  }
} // namespace softcell
