// SPDX-License-Identifier: LGPL-2.1-or-later
// run.json reads back as JSON.

#include <softcell/output/run_record.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

using namespace softcell;

TEST(RunRecord, IsJsonAndKeepsEveryCharacter)
{
  RunRecord record;
  record.command_line = "softcell --set 'Loads/top = \"x\\y\"\t'";
  record.status       = "done";
  record.ranks        = 3;
  record.wall_s       = 1.25;
  record.parameters   = {{"Geometry/File", "a.b/c\nd"}, {"Material/Model", "linear"}};
  record.remarks      = {"one", "two, three"};

  record.linear_residuals = {{"a", {1, 0.25}}, {"b", {}}};

  std::istringstream text(json(record));
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(text, tree);
  EXPECT_EQ(tree.get<std::string>("command_line"), record.command_line);
  EXPECT_EQ(tree.get<std::string>("status"), "done");
  EXPECT_EQ(tree.get<int>("ranks"), 3);
  EXPECT_EQ(tree.get<double>("wall_s"), 1.25);
  EXPECT_EQ(tree.get_child("parameters").front().second.data(), "a.b/c\nd");
  EXPECT_EQ(tree.get_child("parameters").size(), 2u);
  EXPECT_EQ(tree.get_child("linear_residuals.a").size(), 2u);
  EXPECT_EQ(tree.get_child("linear_residuals.a").back().second.get_value<double>(), 0.25);
  EXPECT_EQ(tree.get_child("linear_residuals").size(), 2u);
  EXPECT_EQ(tree.get_child("remarks").back().second.data(), "two, three");
  EXPECT_EQ(tree.get_child("libraries").find("deal.II")->second.data().substr(0, 2), "9.");
  EXPECT_FALSE(tree.get<std::string>("host").empty());
}

TEST(RunRecord, GivesBackTheResidualsOfItsFirstCase)
{
  const std::string file =
    "run_record_test_" + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) +
    ".json";
  RunRecord record;
  record.linear_residuals = {{"weighted_cell_0.5", {1, 0.25, 1e-9}}, {"b", {2}}};
  write_run_record(file, record);
  EXPECT_EQ(read_linear_residuals(file), (std::vector<double>{1, 0.25, 1e-9}));
  record.linear_residuals.clear();
  write_run_record(file, record);
  EXPECT_TRUE(read_linear_residuals(file).empty());
  std::remove(file.c_str());
  EXPECT_TRUE(read_linear_residuals(file).empty());
}

TEST(RunRecord, KeepsTheFirstFailure)
{
  const bool is_root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  const char *file   = "run_record_test_failed.json";
  RunRecord record;
  const auto write_on_all = [&](const std::string &message) {
    MPI_Barrier(MPI_COMM_WORLD);
    record.status  = "failed";
    record.message = message;
    write_failure(file, record);
    MPI_Barrier(MPI_COMM_WORLD);
    boost::property_tree::ptree tree;
    boost::property_tree::read_json(file, tree);
    return tree.get<std::string>("message");
  };
  if (is_root)
    write_run_record(file, record); // running
  EXPECT_EQ(write_on_all("first"), "first");
  EXPECT_EQ(write_on_all("second"), "first");
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_root)
    std::remove(file);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(write_on_all("without a file before"), "without a file before");
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_root)
    std::remove(file);
}
