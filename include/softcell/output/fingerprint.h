// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether a result would come out the same again.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// A number of 16 hexadecimal digits for everything that results depend on: the values, of those
  /// that name a file also its size and time of change, with those of the voxels that the
  /// header of an image names, and the program. That is its version and commit; if it was built
  /// from sources that were not committed, every byte of it.
  /// @param values parameters by name, and whatever else tells results apart.
  /// @throws BadInput for such a header that cannot be understood.
  std::string fingerprint(const std::vector<std::pair<std::string, std::string>> &values);
} // namespace softcell
