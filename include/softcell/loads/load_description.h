// SPDX-License-Identifier: LGPL-2.1-or-later
// The entries of the section Loads, one for each region.
#pragma once

#include <softcell/discretization/region.h>

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// One load of an entry `NAME = kind value; kind value; ...` of the section Loads.
  struct LoadDescription
  {
    enum class Kind
    {
      displacement,
      traction,
      pressure,
      springs
    };

    std::string region;
    Kind kind;
    std::string value; // its expressions, `exact`, `reference` or `path`
    std::string place; // `Loads/NAME = 'kind value'`, for messages

    /// Is it that of the manufactured solution?
    bool is_exact() const
    {
      return value == "exact";
    }
    /// Is it the displacement of the reference run?
    bool is_of_reference() const
    {
      return value == "reference";
    }
    /// Is it the displacement that was recorded?
    bool is_path() const
    {
      return value == "path";
    }
  };

  /// Reads entries (name of a region, text):
  ///   clamp | displacement ux, uy, uz | traction tx, ty, tz | pressure p | springs k
  /// with values in m, Pa and Pa/m that are expressions of x, y, z and t. Values that do not
  /// contain t are multiplied by the load factor t, but for k. `displacement exact` and `traction
  /// exact` are those of the manufactured solution, `displacement reference` that of a study's
  /// reference run, times t, `displacement path` what Loads/Path has recorded.
  /// @throws BadInput
  std::vector<LoadDescription>
  parse_loads(const std::vector<std::pair<std::string, std::string>> &entries,
              const std::vector<Region> &regions);

  /// The region of this name. @throws BadInput if there is none.
  const Region &find_region(const std::string &name, const std::vector<Region> &regions);
} // namespace softcell
