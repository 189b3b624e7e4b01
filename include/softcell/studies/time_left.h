// SPDX-License-Identifier: LGPL-2.1-or-later
// How long the rest of a study will take.
#pragma once

#include <string>
#include <vector>

namespace softcell
{
  /// How large a run is.
  struct Work
  {
    std::string kind; // runs of the same kind, as method and degree, are the best to compare with
    double points   = 0;
    double unknowns = 0;
  };

  /// Guesses from the runs that are done. A run is taken to last as long as the one of its kind
  /// that is nearest in effort (of any kind if there is none), times the ratio of both efforts.
  /// Effort is points + unknowns^(4/3): assembling goes by the points, and conjugate gradients take
  /// iterations like the number of cells across.
  class TimeLeft
  {
  public:
    void add(const Work &work, double seconds);

    /// Units: s. NaN while nothing is done.
    double guess(const Work &work) const;

  private:
    struct Done
    {
      Work work;
      double seconds;
    };
    std::vector<Done> done_;
  };

  /// `40 s`, `12 min`, `3 h 20 min`.
  std::string duration(double seconds);
} // namespace softcell
