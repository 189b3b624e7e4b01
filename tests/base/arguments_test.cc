// SPDX-License-Identifier: LGPL-2.1-or-later
// What the command line may hold, and what is said of the rest.

#include <softcell/base/arguments.h>

#include <softcell/base/exceptions.h>

#include <gtest/gtest.h>

namespace softcell
{
  TEST(Arguments, AreRead)
  {
    const Arguments arguments =
      read_arguments({"--set", "A/b = 1", "liver.prm", "--output", "there", "--check", "--quiet"});
    EXPECT_EQ(arguments.file, "liver.prm");
    EXPECT_EQ(arguments.settings,
              (std::vector<std::string>{"A/b = 1", "Output/Directory = there"}));
    EXPECT_TRUE(arguments.check && arguments.quiet);
    EXPECT_FALSE(arguments.help || arguments.version || arguments.print_parameters);
  }

  TEST(Arguments, NameWhatIsWrong)
  {
    const auto complaint = [](const std::vector<std::string> &words) -> std::string {
      try
      {
        read_arguments(words);
      }
      catch (const BadInput &error)
      {
        return error.what();
      }
      return "";
    };
    EXPECT_NE(complaint({"--set"}).find("--set needs a value"), std::string::npos);
    EXPECT_NE(complaint({"--chek"}).find("no option --chek"), std::string::npos);
    EXPECT_NE(complaint({"a.prm", "b.prm"}).find("not a.prm and b.prm"), std::string::npos);
  }
} // namespace softcell
