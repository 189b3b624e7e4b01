// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line of softcell.

#include <softcell/base/console.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/version.h>
#include <softcell/procedures/parameters.h>
#include <softcell/studies/study.h>

#include <deal.II/base/mpi.h>

#include <omp.h>

#include <cstdlib>
#include <iostream>

namespace
{
  constexpr const char *usage =
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

  /// The command line, read.
  struct Arguments
  {
    std::string file;
    std::vector<std::string> settings;
    bool check = false, quiet = false, print_parameters = false, help = false, version = false;
  };

  Arguments read_arguments(const std::vector<std::string> &words)
  {
    Arguments arguments;
    const auto value_of = [&](std::size_t &i) {
      if (i + 1 == words.size())
        throw softcell::BadInput(words[i] + " needs a value after it; see softcell --help.");
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
      else if (words[i].rfind("-", 0) == 0)
        throw softcell::BadInput("There is no option " + words[i] + "; see softcell --help.");
      else if (!arguments.file.empty())
        throw softcell::BadInput("Give one parameter file, not " + arguments.file + " and " +
                                 words[i] + ".");
      else
        arguments.file = words[i];
    return arguments;
  }

  int run(const std::vector<std::string> &words)
  {
    const bool is_root        = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    const Arguments arguments = read_arguments(words);
    if (arguments.help || arguments.version || arguments.print_parameters)
    {
      if (is_root && arguments.help)
        std::cout << usage;
      else if (is_root && arguments.version)
        std::cout << "softcell " << softcell::version << '\n';
      else if (is_root)
      {
        dealii::ParameterHandler prm;
        softcell::Parameters().add_parameters(prm);
        softcell::print_parameters(prm, std::cout);
      }
      return 0;
    }
    if (arguments.file.empty())
      throw softcell::BadInput("Which parameter file? Say softcell FILE.prm; see softcell --help.");

    softcell::Console console(MPI_COMM_WORLD, arguments.quiet);
    return softcell::run_study(arguments.file, arguments.settings, words, arguments.check, console);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::deal_II_exceptions::disable_abort_on_exception();
  // MUMPS would have as many threads as there are cores in every rank.
  if (std::getenv("OMP_NUM_THREADS") == nullptr)
    omp_set_num_threads(1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  try
  {
    return run({argv + 1, argv + argc});
  }
  catch (const softcell::BadInput &error)
  {
    if (rank == 0)
      std::cerr << "softcell: " << error.what() << std::endl;
    return 1;
  }
  catch (const softcell::NotConverged &error)
  {
    if (rank == 0)
      std::cerr << "softcell: " << error.what() << std::endl;
    return 2;
  }
  catch (const std::bad_alloc &)
  {
    std::cerr << "softcell: out of memory on rank " << rank << "; use fewer cells or more machines."
              << std::endl;
  }
  catch (const std::exception &error)
  {
    std::cerr << "softcell: unforeseen error on rank " << rank << ": " << error.what() << std::endl;
  }
  // The other ranks may be waiting for this one.
  MPI_Abort(MPI_COMM_WORLD, 3);
  return 3;
}
