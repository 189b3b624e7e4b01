// SPDX-License-Identifier: LGPL-2.1-or-later
// How much memory this machine has to give, and whether it is enough.

#include <softcell/base/memory.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace softcell
{
  namespace
  {
    /// The number behind a word of a file, or at its beginning; NaN if there is none.
    double number_in(const std::string &file, const std::string &word = "")
    {
      std::ifstream in(file);
      std::string found;
      while (found != word && in >> found)
        ;
      double number;
      return in >> number ? number : std::numeric_limits<double>::quiet_NaN();
    }

    /// What is left below the limit of a control group, its cached files not counted. Units: bytes
    double left_in(const std::string &folder, const bool is_version_2)
    {
      return is_version_2
               ? number_in(folder + "/memory.max") - number_in(folder + "/memory.current") +
                   number_in(folder + "/memory.stat", "inactive_file")
               : number_in(folder + "/memory.limit_in_bytes") -
                   number_in(folder + "/memory.usage_in_bytes") +
                   number_in(folder + "/memory.stat", "total_inactive_file");
    }
  } // namespace

  double free_memory()
  {
    double free = 1024 * number_in("/proc/meminfo", "MemAvailable:");
    std::ifstream groups("/proc/self/cgroup"); // lines NUMBER:CONTROLLERS:PATH
    for (std::string line; std::getline(groups, line);)
    {
      const std::size_t first = line.find(':'), second = line.find(':', first + 1);
      const std::string controllers = line.substr(first + 1, second - first - 1);
      const bool is_version_2       = controllers.empty();
      if (!is_version_2 && controllers != "memory")
        continue;
      std::filesystem::path path = line.substr(second + 1);
      for (bool is_root = false; !is_root; path = path.parent_path())
      {
        is_root = path == path.parent_path();
        free    = std::fmin(
             free, left_in((is_version_2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory") + path.string(),
                           is_version_2));
      }
    }
    return std::isnan(free) ? std::numeric_limits<double>::infinity() : free;
  }

  void check_memory(const double shared,
                    const double by_each,
                    const std::string &what,
                    const std::string &remedy,
                    MPI_Comm communicator)
  {
    namespace mpi = dealii::Utilities::MPI;
    MPI_Comm machine;
    MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const unsigned int n_here = mpi::n_mpi_processes(machine);
    MPI_Comm_free(&machine);

    const unsigned int n_ranks = mpi::n_mpi_processes(communicator);
    const std::array<double, 2> here{{n_here * (shared / n_ranks + by_each), free_memory()}};
    std::array<double, 2> worst{{0, 1}};
    for (const auto &each : mpi::all_gather(communicator, here))
      if (each[0] * worst[1] > worst[0] * each[1])
        worst = each;
    if (worst[0] <= worst[1])
      return;
    constexpr double gib = 1 << 30;
    std::ostringstream text;
    text.precision(3);
    text << what << " takes about " << worst[0] / gib << " GiB of memory";
    if (n_ranks > n_here)
      text << " on a machine";
    text << ", where " << worst[1] / gib << " GiB are free; " << remedy << '.';
    throw BadInput(text.str());
  }
} // namespace softcell
