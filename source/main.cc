// SPDX-License-Identifier: LGPL-2.1-or-later
// The program.

#include <softcell/base/arguments.h>
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
  int run(const std::vector<std::string> &words)
  {
    const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    const softcell::Arguments arguments = softcell::read_arguments(words);
    if (arguments.help || arguments.version || arguments.print_parameters)
    {
      if (is_root && arguments.help)
        std::cout << softcell::help_text;
      else if (is_root && arguments.version)
        std::cout << "softcell " << softcell::version << '\n';
      else if (is_root)
      {
        dealii::ParameterHandler prm;
        softcell::Parameters().add_parameters(prm);
        softcell::print_parameters(prm, std::cout);
        std::cout << '\n' << softcell::free_sections;
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
      std::cerr << "softcell: " << softcell::printable(error.what()) << std::endl;
    return 1;
  }
  catch (const softcell::NotConverged &error)
  {
    if (rank == 0)
      std::cerr << "softcell: " << softcell::printable(error.what()) << std::endl;
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
