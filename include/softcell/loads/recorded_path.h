// SPDX-License-Identifier: LGPL-2.1-or-later
// The way that a tool took, read from a file.
#pragma once

#include <softcell/base/types.h>

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// A displacement as a function of time, linear between the recorded ones.
  class RecordedPath
  {
  public:
    /// Reads lines `t, x, y, z` (s and m, t ascending), after one of names if there is one.
    /// @throws BadInput
    explicit RecordedPath(const std::string &file);

    /// Before the first record and after the last one that of these. Units: m
    Direction displacement(double t) const;

    /// Time of the last record. Units: s
    double end() const
    {
      return records_.back().first;
    }

  private:
    std::vector<std::pair<double, Direction>> records_;
  };
} // namespace softcell
