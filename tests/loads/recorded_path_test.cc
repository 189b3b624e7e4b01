// SPDX-License-Identifier: LGPL-2.1-or-later
// A tool's way between its records, before and after them.

#include <softcell/base/exceptions.h>
#include <softcell/loads/recorded_path.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

namespace
{
  using namespace softcell;

  RecordedPath path_of(const std::string &text)
  {
    struct File
    {
      std::string name = "path" + std::to_string(getpid()) + ".csv"; // one per rank
      ~File()
      {
        std::remove(name.c_str());
      }
    } file;
    std::ofstream(file.name) << text;
    return RecordedPath(file.name);
  }

  TEST(RecordedPath, IsLinearBetweenItsRecordsAndStaysAtItsEnds)
  {
    const RecordedPath path = path_of("t, x, y, z\n0.5, 1, 2, 3\r\n\n1.5 2 0 -3\n");
    EXPECT_EQ(path.end(), 1.5);
    const auto expect = [&](const double t, const Direction &displacement) {
      EXPECT_LT((path.displacement(t) - displacement).norm(), 1e-15) << t;
    };
    expect(0, Direction(Point(1, 2, 3)));
    expect(0.5, Direction(Point(1, 2, 3)));
    expect(0.75, Direction(Point(1.25, 1.5, 1.5)));
    expect(1.5, Direction(Point(2, 0, -3)));
    expect(9, Direction(Point(2, 0, -3)));
  }

  TEST(RecordedPath, NamesTheLineThatIsWrong)
  {
    for (const std::string second : {"1, 2, 3", "1, 2, 3, 4, 5", "1, 2, 3, nan", "0, 0, 0, 0"})
      try
      {
        path_of("0, 0, 0, 0\n" + second + "\n");
        ADD_FAILURE() << second;
      }
      catch (const BadInput &error)
      {
        EXPECT_NE(std::string(error.what()).find("Line 2"), std::string::npos) << error.what();
      }
  }
} // namespace
