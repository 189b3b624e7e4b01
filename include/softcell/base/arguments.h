// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line.
#pragma once

#include <string>
#include <vector>

namespace softcell
{
  /// What `softcell --help` prints.
  extern const char *const help_text;

  /// The command line, read.
  struct Arguments
  {
    std::string file;
    std::vector<std::string> settings; // `Section/Entry = value`
    bool check = false, quiet = false, print_parameters = false, help = false, version = false;
  };

  /// @param words without the program's name.
  /// @throws BadInput
  Arguments read_arguments(const std::vector<std::string> &words);
} // namespace softcell
