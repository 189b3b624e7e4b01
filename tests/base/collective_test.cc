// SPDX-License-Identifier: LGPL-2.1-or-later
// All ranks hear of a failure, in every way that one can fail.

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>

using namespace softcell;

namespace
{
  /// What `act` throws as BadInput.
  std::string complaint_of(const std::function<void()> &act)
  {
    try
    {
      act();
    }
    catch (const BadInput &error)
    {
      return error.what();
    }
    return "";
  }
} // namespace

TEST(Collective, all_ranks_hear_of_the_one_that_failed)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  for (unsigned int failing = 0; failing < n_ranks; ++failing)
  {
    const std::string complaint = "no file on rank " + std::to_string(failing);
    EXPECT_EQ(complaint_of([&] {
                on_all(MPI_COMM_WORLD, [&] {
                  if (rank == failing)
                    throw BadInput(complaint);
                });
              }),
              complaint);
  }
}

TEST(Collective, the_first_of_several_complaints_is_everyones)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int first   = std::min(1u, n_ranks - 1);
  EXPECT_EQ(complaint_of([&] {
              throw_on_all(MPI_COMM_WORLD, rank < first ? "" : "rank " + std::to_string(rank));
            }),
            "rank " + std::to_string(first));
}

TEST(Collective, only_the_root_acts_but_all_hear)
{
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  EXPECT_EQ(complaint_of([&] {
              on_root(MPI_COMM_WORLD, [&] { throw BadInput("no room " + std::to_string(rank)); });
            }),
            "no room 0");
}

TEST(Collective, says_nothing_where_all_went_well)
{
  unsigned int n_runs = 0;
  EXPECT_NO_THROW(on_all(MPI_COMM_WORLD, [&] { ++n_runs; }));
  EXPECT_EQ(n_runs, 1u);
  EXPECT_NO_THROW(on_root(MPI_COMM_WORLD, [&] { ++n_runs; }));
  EXPECT_EQ(n_runs, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0 ? 2u : 1u);
}
