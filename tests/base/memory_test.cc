// SPDX-License-Identifier: LGPL-2.1-or-later
// Memory that is left and how ranks share it.

#include <softcell/base/exceptions.h>
#include <softcell/base/memory.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <unistd.h>

using namespace softcell;

TEST(Memory, IsNotMoreThanTheMachineHas)
{
  EXPECT_GT(free_memory(), 1e6);
  EXPECT_LT(free_memory(), double(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE));
}

TEST(Memory, IsSharedByTheRanksOfAMachine)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const auto is_enough       = [](const double shared, const double by_each) {
    try
    {
      check_memory(shared, by_each, "What", "how", MPI_COMM_WORLD);
      return true;
    }
    catch (const BadInput &)
    {
      return false;
    }
  };
  const double free = free_memory();
  EXPECT_TRUE(is_enough(0.6 * free, 0));
  EXPECT_FALSE(is_enough(1.5 * free, 0));
  EXPECT_EQ(is_enough(0, 0.6 * free), n_ranks == 1);
}

TEST(Memory, SaysWhatTakesIt)
{
  try
  {
    check_memory(1e18, 0, "Cells = 9", "give fewer", MPI_COMM_WORLD);
    FAIL();
  }
  catch (const BadInput &error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.find("Cells = 9 takes about 9.31e+08 GiB of memory, where "), 0u) << text;
    EXPECT_NE(text.find(" GiB are free; give fewer."), std::string::npos) << text;
  }
}
