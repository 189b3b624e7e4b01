// SPDX-License-Identifier: LGPL-2.1-or-later
// Expressions that a user writes, in muParser's syntax.
#pragma once

#include <muParser.h>

#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// The parser of one expression of some variables and pi. It assigns nothing.
  /// @param variables their names, and where their values stand whenever the parser evaluates.
  /// @param complaint,remedy of the message: what cannot be read where, and what to give instead.
  /// @throws BadInput
  mu::Parser make_formula(const std::string &text,
                          const std::vector<std::pair<std::string, double *>> &variables,
                          const std::string &complaint,
                          const std::string &remedy);
} // namespace softcell
