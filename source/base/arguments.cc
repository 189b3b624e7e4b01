// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line.

#include <softcell/base/arguments.h>

#include <softcell/base/exceptions.h>

namespace softcell
{
  const char *const help_text =
    "Usage: softcell FILE.prm [--set 'Section/Entry = value']... [--output DIR] [--check] "
    "[--quiet]\n"
    "       softcell --print-parameters\n"
    "       softcell --help | --version\n"
    "\n"
    "Deforms the body that a parameter file describes and writes its displacement, its error and "
    "its\n"
    "cost. Runs alone and under mpirun.\n"
    "\n"
    "  --set 'Section/Entry = value'  takes the place of an entry of the file; may be repeated\n"
    "  --output DIR                   where to write; instead of Output/Directory\n"
    "  --check                        read everything, say how large the problem is, solve "
    "nothing\n"
    "  --quiet                        only warnings and errors\n"
    "  --print-parameters             every entry with its default, unit and documentation\n"
    "\n"
    "Exit status: 0 done, 1 bad input, 2 not converged (what was reached is written), 3 "
    "unforeseen.\n";

  Arguments read_arguments(const std::vector<std::string> &words)
  {
    Arguments arguments;
    const auto value_of = [&](std::size_t &i) {
      if (i + 1 == words.size())
        throw BadInput(words[i] + " needs a value after it; see softcell --help.");
      return words[++i];
    };
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] == "--set")
        arguments.settings.push_back(value_of(i));
      else if (words[i] == "--output")
        arguments.settings.push_back("Output/Directory = " + value_of(i));
      else if (words[i] == "--check")
        arguments.check = true;
      else if (words[i] == "--quiet")
        arguments.quiet = true;
      else if (words[i] == "--print-parameters")
        arguments.print_parameters = true;
      else if (words[i] == "--help" || words[i] == "-h")
        arguments.help = true;
      else if (words[i] == "--version")
        arguments.version = true;
      else if (words[i].rfind('-', 0) == 0)
        throw BadInput("There is no option " + words[i] + "; see softcell --help.");
      else if (!arguments.file.empty())
        throw BadInput("Give one parameter file, not " + arguments.file + " and " + words[i] + ".");
      else
        arguments.file = words[i];
    return arguments;
  }
} // namespace softcell
