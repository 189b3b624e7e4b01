// SPDX-License-Identifier: LGPL-2.1-or-later
// What a fingerprint depends on.

#include <softcell/output/fingerprint.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

using namespace softcell;

TEST(Fingerprint, ChangesWithEveryValueAndName)
{
  const std::string one = fingerprint({{"Material/Young modulus", "5000"}, {"Loads/top", "clamp"}});
  EXPECT_EQ(one.size(), 16u);
  EXPECT_EQ(one, fingerprint({{"Material/Young modulus", "5000"}, {"Loads/top", "clamp"}}));
  EXPECT_NE(one, fingerprint({{"Material/Young modulus", "5001"}, {"Loads/top", "clamp"}}));
  EXPECT_NE(one, fingerprint({{"Material/Young modulus", "5000"}, {"Loads/base", "clamp"}}));
  EXPECT_NE(one, fingerprint({{"Material/Young modulus", "5000"}}));
}

TEST(Fingerprint, ChangesWithTheFileThatAValueNames)
{
  const std::string file =
    "fingerprint_test_" + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) +
    ".off";
  std::ofstream(file) << "OFF";
  const std::string one = fingerprint({{"Geometry/File", file}});
  EXPECT_EQ(one, fingerprint({{"Geometry/File", file}}));
  std::ofstream(file) << "OFF 4";
  EXPECT_NE(one, fingerprint({{"Geometry/File", file}}));
  std::remove(file.c_str());
}

TEST(Fingerprint, ChangesWithTheVoxelsThatAHeaderNames)
{
  const std::string name =
    "fingerprint_test_" + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  for (const char *const ending : {".mhd", ".mha"})
    std::ofstream(name + ending) << "DimSize = 1 1 1\nElementType = MET_UCHAR\nElementDataFile = "
                                 << name << ".raw\n";
  for (const char *const ending : {".nhdr", ".nrrd"})
    std::ofstream(name + ending) << "NRRD0004\nsizes: 1 1 1\ntype: uchar\nencoding: raw\n"
                                 << "data file: " << name << ".raw\n\n";
  for (const char *const ending : {".mhd", ".mha", ".nhdr", ".nrrd"})
  {
    std::ofstream(name + ".raw") << "1";
    const std::string one = fingerprint({{"Geometry/File", name + ending}});
    EXPECT_EQ(one, fingerprint({{"Geometry/File", name + ending}}));
    std::ofstream(name + ".raw") << "12";
    EXPECT_NE(one, fingerprint({{"Geometry/File", name + ending}}));
  }
  for (const char *const ending : {".mhd", ".mha", ".nhdr", ".nrrd", ".raw"})
    std::remove((name + ending).c_str());
}
