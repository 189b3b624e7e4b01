// SPDX-License-Identifier: LGPL-2.1-or-later
// Progress in logs and on terminals, and the sums of timers.

#include <softcell/base/console.h>

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

using namespace softcell;

TEST(Console, LogGetsProgressAtIntervals)
{
  std::ostringstream out;
  Console console(out, false, 3600);
  console.progress("step 1");
  console.progress("step 2");
  console.say("done");
  EXPECT_EQ(out.str(), "step 1\ndone\n");
}

TEST(Console, LogWithoutIntervalGetsAllProgress)
{
  std::ostringstream out;
  Console console(out, false, 0);
  console.progress("step 1");
  console.progress("step 2");
  EXPECT_EQ(out.str(), "step 1\nstep 2\n");
}

TEST(Console, TerminalLineIsRewrittenAndErased)
{
  std::ostringstream out;
  {
    Console console(out, true, 3600);
    console.progress("step 1");
    console.progress("step 2");
    console.warn("odd");
    console.progress("step 3");
  }
  EXPECT_EQ(out.str(), "\r\033[Kstep 1\r\033[Kstep 2\r\033[Kwarning: odd\n\r\033[Kstep 3\r\033[K");
}

TEST(Timers, SumAndMean)
{
  Timers timers;
  timers.add("assembly", 2);
  timers.add("assembly", 4);
  EXPECT_EQ(timers.seconds("assembly"), 6);
  EXPECT_EQ(timers.mean("assembly"), 3);
  EXPECT_EQ(timers.seconds("solve"), 0);
  EXPECT_EQ(timers.mean("solve"), 0);
}

TEST(Timers, ScopeMeasuresItsLife)
{
  Timers timers;
  {
    const Timers::Scope scope(timers, "sleep");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_GE(timers.seconds("sleep"), 0.02);
  EXPECT_LE(timers.seconds("sleep"), timers.total());

  std::ostringstream out;
  Console console(out, false, 0);
  timers.print(console);
  EXPECT_NE(out.str().find("sleep"), std::string::npos);
  EXPECT_NE(out.str().find("1 x"), std::string::npos);
}

TEST(Memory, CountsWhatIsTouched)
{
  const std::vector<char> touched(256 << 20, 1);
  EXPECT_GT(peak_rss_mib(MPI_COMM_WORLD), 256);
  EXPECT_EQ(touched.back(), 1);
}

TEST(Console, ShowsOnlyWhatATerminalCan)
{
  EXPECT_EQ(printable("K\u00fcgel \u20ac \U0001f600"), "K\u00fcgel \u20ac \U0001f600");
  EXPECT_EQ(printable("a\x1b[2Jb\nc\x7f"), "a?[2Jb?c?");
  EXPECT_EQ(printable("\xff\xc3x\xe2\x82"), "??x??");
  const std::string text = printable(std::string(100000, 'x') + "; mend it.");
  EXPECT_LT(text.size(), 1100u);
  EXPECT_NE(text.find("x ... x"), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 10), "; mend it.");
}
