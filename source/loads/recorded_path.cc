// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a tool's way.

#include <softcell/loads/recorded_path.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace softcell
{
  namespace
  {
    /// The four numbers of a line, if it has them.
    bool read_record(std::string line, std::pair<double, Direction> &record)
    {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream stream(line);
      auto &[t, u] = record;
      return stream >> t >> u[0] >> u[1] >> u[2] && (stream >> std::ws).eof() &&
             std::isfinite(t + u[0] + u[1] + u[2]);
    }
  } // namespace

  RecordedPath::RecordedPath(const std::string &file)
  {
    check_file("Loads/Path = " + file, file);
    std::ifstream stream(file);
    unsigned int number = 0;
    for (std::string line; std::getline(stream, line);)
    {
      ++number;
      if (line.find_first_not_of(" \t\r") == std::string::npos)
        continue;
      std::pair<double, Direction> record;
      const std::string place =
        "Line " + std::to_string(number) + " of Loads/Path = '" + file + "'";
      if (read_record(line, record))
      {
        if (!records_.empty() && record.first <= records_.back().first)
          throw BadInput(place + " has a time that is not later than the one before; sort the "
                                 "lines by time.");
        records_.push_back(record);
      }
      else if (number > 1)
        throw BadInput(place + " is '" + line +
                       "', which is no time (s) and displacement (m); give "
                       "four numbers separated by commas.");
    }
    if (records_.empty())
      throw BadInput("Loads/Path = '" + file +
                     "' has no line of a time (s) and a displacement (m).");
  }

  Direction RecordedPath::displacement(const double t) const
  {
    const auto next =
      std::upper_bound(records_.begin(), records_.end(), t,
                       [](const double time, const auto &record) { return time < record.first; });
    if (next == records_.begin())
      return next->second;
    const auto &[t_0, u_0] = *(next - 1);
    if (next == records_.end())
      return u_0;
    const double share = (t - t_0) / (next->first - t_0);
    return (1 - share) * u_0 + share * next->second;
  }
} // namespace softcell
