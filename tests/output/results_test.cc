// SPDX-License-Identifier: LGPL-2.1-or-later
// results.csv as a reader of tables sees it.

#include <softcell/base/exceptions.h>
#include <softcell/output/results.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

using namespace softcell;

namespace
{
  std::string results_file()
  {
    return "results_test_" +
           std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + ".csv";
  }
} // namespace

TEST(Results, StandardColumnsComeFirst)
{
  ResultsRow row;
  row.set("tip_uz", 0.5);
  row.set("dofs", 300u);
  row.set("case", "liver");
  write_results(results_file(), {row});
  std::ifstream in(results_file());
  std::string header, values;
  std::getline(in, header);
  std::getline(in, values);
  EXPECT_EQ(
    header,
    "case,method,degree,cut_levels,cells,cut_cells,dofs,integration_points,load_steps,"
    "newton_iterations,linear_iterations,setup_s,assembly_s,solve_s,total_s,peak_rss_mib,volume,"
    "strain_energy,l2_displacement,min_jacobian,converged,tip_uz");
  EXPECT_EQ(values, "liver,,,,,,300,,,,,,,,,,,,,,,0.5");
  std::remove(results_file().c_str());
}

TEST(Results, KnowsTheColumnsThatOnlySomeRowsHave)
{
  const std::vector<std::string> columns = results_columns();
  for (const char *const name :
       {"refinement_steps", "estimated_error", "mean_surface_error", "max_surface_error"})
    EXPECT_EQ(std::count(columns.begin(), columns.end(), name), 1) << name;
}

TEST(Results, QuotesTextAndKeepsEveryDigit)
{
  ResultsRow first, second;
  first.set("case", "a \"quoted\", long\nname");
  first.set("volume", 0.1 + 0.2);
  second.set("case", "b");
  second.set("relative_l2_error", std::nextafter(1e-7, 1));
  EXPECT_EQ(first.number("volume"), 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(first.number("relative_l2_error")));
  EXPECT_EQ(second.number("relative_l2_error"), std::nextafter(1e-7, 1));
  write_results(results_file(), {first, second});

  std::stringstream text;
  text << std::ifstream(results_file()).rdbuf();
  EXPECT_NE(text.str().find("\n\"a \"\"quoted\"\", long\nname\",,"), std::string::npos);
  EXPECT_NE(text.str().find("," + first.get("volume") + ","), std::string::npos);
  EXPECT_NE(text.str().find("," + second.get("relative_l2_error") + "\n"), std::string::npos);
  std::remove(results_file().c_str());
}

TEST(Results, NamesAFolderThatIsNotThere)
{
  EXPECT_THROW(write_results("no/such/folder/results.csv", {}), BadInput);
}

TEST(Results, AreReadAsTheyWereWritten)
{
  ResultsRow first, second;
  first.set("case", "a \"quoted\", long\nname");
  first.set("volume", 0.1 + 0.2);
  second.set("case", "\"");
  second.set("tip_ux", -1.5);
  write_results(results_file(), {first, second});

  const std::vector<ResultsRow> rows = read_results(results_file());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].values(), first.values());
  EXPECT_EQ(rows[1].values(), second.values());
  std::remove(results_file().c_str());
  EXPECT_TRUE(read_results(results_file()).empty());
}
