// SPDX-License-Identifier: LGPL-2.1-or-later
// The bodies of a study.
#pragma once

#include <softcell/base/console.h>
#include <softcell/geometry/body.h>
#include <softcell/procedures/parameters.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// Makes each body once, however many runs have it.
  class Bodies
  {
  public:
    /// The body of a run, which stays as long as this. When it is made, the console gets its size.
    /// Collective.
    /// @param remarks gets what a user should know of it, when it is made.
    /// @throws BadInput
    const Body &
    get(const Parameters &parameters, Console &console, std::vector<std::string> &remarks);

  private:
    std::map<std::string, std::unique_ptr<Body>> bodies_; // by what they are made from
  };
} // namespace softcell
