// SPDX-License-Identifier: LGPL-2.1-or-later
// Named parts of a body's boundary.
#pragma once

#include <softcell/base/types.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// A part of the boundary, told by a condition on a boundary triangle's or face's centre (x, y,
  /// z), unit outward normal (nx, ny, nz) and patch number: either an expression that is true there
  /// (muParser's syntax, true if not 0) or `patch K` of the surface file.
  class Region
  {
  public:
    /// @throws BadInput if the expression cannot be read.
    Region(std::string name, const std::string &condition);
    ~Region();
    Region(Region &&) noexcept;

    const std::string &name() const
    {
      return name_;
    }
    /// Not to be called by several threads at once.
    bool contains(const Point &X, const Direction &normal, unsigned int patch) const;

  private:
    struct Condition;
    std::string name_;
    std::unique_ptr<Condition> condition_;
  };

  /// Those of the section Regions: name and condition each.
  /// @throws BadInput
  std::vector<Region> make_regions(const std::vector<std::pair<std::string, std::string>> &entries);
} // namespace softcell
