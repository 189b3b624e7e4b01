// SPDX-License-Identifier: LGPL-2.1-or-later
// Failures of one rank that all ranks hear of, so that none waits for ever.

#include <softcell/base/collective.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

namespace softcell
{
  void throw_on_all(MPI_Comm communicator, const std::string &complaint)
  {
    for (const std::string &any : dealii::Utilities::MPI::all_gather(communicator, complaint))
      if (!any.empty())
        throw BadInput(any);
  }

  void on_all(MPI_Comm communicator, const std::function<void()> &act)
  {
    std::string complaint;
    try
    {
      act();
    }
    catch (const BadInput &error)
    {
      complaint = error.what();
    }
    throw_on_all(communicator, complaint);
  }

  void on_root(MPI_Comm communicator, const std::function<void()> &act)
  {
    on_all(communicator, [&] {
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        act();
    });
  }
} // namespace softcell
