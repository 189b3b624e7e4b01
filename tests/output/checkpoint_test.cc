// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints read back, and what is wrong with others.

#include "one_tetrahedron.h"

#include <softcell/base/exceptions.h>
#include <softcell/output/checkpoint.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <hdf5.h>

using namespace softcell;

TEST(Checkpoint, ReadsBack)
{
  const test::OneTetrahedronPerRank cells;
  Vector u = cells.make_vector(), v = cells.make_vector();
  // equal positions on two ranks have equal values, as one node would
  for (unsigned int i = 0; i < 4; ++i)
    for (unsigned int d = 0; d < 3; ++d)
      u.local_element(3 * i + d) = cells.node_positions()[i][d] * (1. / 3) + 0.1 * d;
  const Refinement refinement = {{Point(0.1, 0.2, 0.3)}, {Point(1, 2, 3), Point(4, 5, 6)}};
  write_checkpoint("checkpoint_test.h5", cells, u, 0.75, refinement);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(read_checkpoint("checkpoint_test.h5", cells, v), 0.75);
  EXPECT_EQ(read_refinement("checkpoint_test.h5", MPI_COMM_WORLD), refinement);
  for (unsigned int i = 0; i < 12; ++i)
    EXPECT_EQ(v.local_element(i), u.local_element(i));
  MPI_Barrier(MPI_COMM_WORLD);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::remove("checkpoint_test.h5");
}

TEST(Checkpoint, RefusesWhatIsTruncatedOrNoNumber)
{
  const test::OneTetrahedronPerRank cells;
  Vector u = cells.make_vector();
  write_checkpoint("checkpoint_test.h5", cells, u, 0.75);
  const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  if (is_root)
    std::filesystem::resize_file("checkpoint_test.h5",
                                 std::filesystem::file_size("checkpoint_test.h5") / 2);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_THROW(read_checkpoint("checkpoint_test.h5", cells, u), BadInput);
  u.local_element(0) = std::nan("");
  write_checkpoint("checkpoint_test.h5", cells, u, 0.75);
  EXPECT_THROW(read_checkpoint("checkpoint_test.h5", cells, u), BadInput);
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_root)
    std::remove("checkpoint_test.h5");
}

TEST(Checkpoint, RefusesWhatIsNoRefinement)
{
  const test::OneTetrahedronPerRank cells;
  Vector u           = cells.make_vector();
  const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  for (const double round : {0., 7., -1., 8., 0.5, 1e300})
  {
    write_checkpoint("checkpoint_test.h5", cells, u, 0.75, {{Point(1, 2, 3)}});
    if (is_root)
    {
      const hid_t file    = H5Fopen("checkpoint_test.h5", H5F_ACC_RDWR, H5P_DEFAULT),
                  data    = H5Dopen2(file, "refinement", H5P_DEFAULT);
      const double row[4] = {round, 1, 2, 3};
      EXPECT_GE(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, row), 0);
      H5Dclose(data);
      H5Fclose(file);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    if (round == 0 || round == 7)
      EXPECT_EQ(read_refinement("checkpoint_test.h5", MPI_COMM_WORLD).size(), round + 1);
    else
      EXPECT_THROW(read_refinement("checkpoint_test.h5", MPI_COMM_WORLD), BadInput) << round;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  if (is_root)
    std::remove("checkpoint_test.h5");
}

TEST(Checkpoint, MissingFile)
{
  const test::OneTetrahedronPerRank cells;
  Vector u = cells.make_vector();
  EXPECT_THROW(read_refinement("no/such.h5", MPI_COMM_WORLD), BadInput);
  EXPECT_THROW(read_checkpoint("no/such.h5", cells, u), BadInput);
  EXPECT_THROW(write_checkpoint("no/such/folder.h5", cells, u, 1), BadInput);
}
