// SPDX-License-Identifier: LGPL-2.1-or-later
// Files are replaced as a whole; a user hears what cannot be written.

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace softcell;

TEST(Files, ReplacesTheWhole)
{
  const std::string file =
    "files_test_" + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  write_file(file, "a long first text\n");
  write_file(file, "short\n");
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "short\n");
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  std::filesystem::remove(file);
}

TEST(Files, NamesWhatCannotBeWritten)
{
  try
  {
    write_file("no/such/folder/file", "text");
    FAIL();
  }
  catch (const BadInput &error)
  {
    EXPECT_NE(std::string(error.what()).find("no/such/folder/file"), std::string::npos);
  }
}

TEST(Files, NamesAFolderThatCannotBeMade)
{
  EXPECT_THROW(make_folder("/dev/null/folder"), BadInput);
  EXPECT_THROW(check_folder("/dev/null/folder"), BadInput);
}

TEST(Files, LeavesNothingOfAFolderThatIsOnlyChecked)
{
  make_folder("files_test");
  check_folder("files_test/some/more");
  EXPECT_TRUE(std::filesystem::exists("files_test"));
  EXPECT_FALSE(std::filesystem::exists("files_test/some"));
  check_folder("files_test");
  EXPECT_TRUE(std::filesystem::remove("files_test"));
}
