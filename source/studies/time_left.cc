// SPDX-License-Identifier: LGPL-2.1-or-later
// Guesses by effort.

#include <softcell/studies/time_left.h>

#include <cmath>
#include <limits>

namespace softcell
{
  namespace
  {
    double effort(const Work &work)
    {
      return 1 + work.points + std::pow(work.unknowns, 4. / 3);
    }
  } // namespace

  void TimeLeft::add(const Work &work, const double seconds)
  {
    done_.push_back({work, seconds});
  }

  double TimeLeft::guess(const Work &work) const
  {
    double result           = std::numeric_limits<double>::quiet_NaN();
    double nearest          = std::numeric_limits<double>::infinity();
    constexpr double of_all = 1e3; // farther than any other run of the same kind
    for (const Done &done : done_)
    {
      const double ratio = effort(work) / effort(done.work);
      const double distance =
        std::abs(std::log(ratio)) + (done.work.kind == work.kind ? 0 : of_all);
      if (distance <= nearest) // of equals the last one, since its surroundings are most alike
      {
        nearest = distance;
        result  = done.seconds * ratio;
      }
    }
    return result;
  }

  std::string duration(const double seconds)
  {
    const long minutes = std::lround(seconds / 60);
    if (seconds < 90)
      return std::to_string(std::lround(seconds)) + " s";
    if (minutes < 90)
      return std::to_string(minutes) + " min";
    return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
  }
} // namespace softcell
