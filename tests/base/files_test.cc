// SPDX-License-Identifier: LGPL-2.1-or-later
// Files are replaced as a whole; a user hears what cannot be read or written.

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace softcell;

namespace
{
  /// A name of this rank's own.
  std::string own_name()
  {
    return "files_test_" + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }
} // namespace

TEST(Files, ReplacesTheWhole)
{
  const std::string file = own_name();
  write_file(file, "a long first text\n");
  write_file(file, "short\n");
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "short\n");
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  std::filesystem::remove(file);
}

TEST(Files, GrowsSoThatAReaderSeesWhatWasAdded)
{
  const std::string file = own_name();
  write_file(file, "an earlier text\n");
  GrowingFile growing(file);
  std::string expected;
  for (const char *const line : {"a\n", "b\nc\n"})
  {
    growing.add(line);
    expected += line;
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    EXPECT_EQ(text.str(), expected);
  }
  std::filesystem::remove(file);
}

TEST(Files, NamesWhatCannotBeReadByItsWholePath)
{
  const std::string here = std::filesystem::current_path().string();
  const auto complaint   = [](const std::string &file) {
    try
    {
      check_file("Section/Entry = " + file, file);
    }
    catch (const BadInput &error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string file = own_name();
  write_file(file, "text");
  EXPECT_EQ(complaint(file), "");
  std::filesystem::remove(file);
  EXPECT_EQ(
    complaint("./" + file)
      .find("Section/Entry = ./" + file + ": there is no such file as " + here + "/" + file + "."),
    0u);
  EXPECT_EQ(complaint("..").find("Section/Entry = .. is a folder"), 0u);
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

TEST(Files, NamesWhatCannotGrow)
{
  EXPECT_THROW(GrowingFile("no/such/folder/file"), BadInput);
  if (std::filesystem::exists("/dev/full"))
  {
    GrowingFile full("/dev/full"); // a disk without room
    EXPECT_THROW(full.add("text"), BadInput);
  }
}

TEST(Files, NamesAFolderThatCannotBeMade)
{
  EXPECT_THROW(make_folder("/dev/null/folder"), BadInput);
  EXPECT_THROW(check_folder("/dev/null/folder"), BadInput);
}

TEST(Files, LeavesNothingOfAFolderThatIsOnlyChecked)
{
  const std::string folder = own_name();
  make_folder(folder);
  check_folder(folder + "/some/more");
  EXPECT_TRUE(std::filesystem::exists(folder));
  EXPECT_FALSE(std::filesystem::exists(folder + "/some"));
  check_folder(folder);
  EXPECT_TRUE(std::filesystem::remove(folder));
}
