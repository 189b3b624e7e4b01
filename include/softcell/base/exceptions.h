// SPDX-License-Identifier: LGPL-2.1-or-later
// The three ways in which a run can fail that its user should hear about.
#pragma once

#include <stdexcept>
#include <string>

namespace softcell
{
  /// The user's input cannot be used. The message is one sentence that names the file or the entry,
  /// what was found there and what would mend it. Throw it on all ranks or on none. The program
  /// exits with status 1.
  struct BadInput : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// The equations could not be solved. What was reached is written, and the program exits with
  /// status 2.
  struct NotConverged : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// A trial displacement turns a material point inside out (J <= 0) where the law has no value.
  /// Newton's line search and the load stepping catch it and take a smaller step. Throw it on all
  /// ranks or on none.
  struct InvertedPoint : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };
} // namespace softcell
