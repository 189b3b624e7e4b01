// SPDX-License-Identifier: LGPL-2.1-or-later
// The cases that a study makes of its lists and sweeps.

#include <softcell/base/exceptions.h>
#include <softcell/studies/study_cases.h>

#include <gtest/gtest.h>

namespace
{
  using namespace softcell;
}

TEST(StudyCases, combines_what_is_swept_and_gives_levels_only_to_cut_methods)
{
  Parameters p;
  p.study.methods    = "finite cell, sparse grid, tetrahedra 2";
  p.study.degrees    = "1";
  p.study.cells      = "4, 8";
  p.study.cut_levels = "1, 2, 3";

  std::vector<std::string> names;
  for (const StudyCase &one : study_cases(p))
    names.push_back(one.name);
  const std::vector<std::string> expected = {
    "finite_cell_p1_n4_l1", "finite_cell_p1_n4_l2", "finite_cell_p1_n4_l3", "finite_cell_p1_n8_l1",
    "finite_cell_p1_n8_l2", "finite_cell_p1_n8_l3", "sparse_grid_p1_n4",    "sparse_grid_p1_n8",
    "tetrahedra_p2_n4",     "tetrahedra_p2_n8"};
  EXPECT_EQ(names, expected);
}

TEST(StudyCases, settings_say_what_tells_a_case_from_the_others)
{
  Parameters p;
  p.study.methods = "tetrahedra 2";
  p.study.cells   = "8";

  const std::vector<StudyCase> cases = study_cases(p);
  ASSERT_EQ(cases.size(), 1u);
  const std::vector<std::string> expected = {
    "Discretization/Method = tetrahedra", "Discretization/Degree = 2", "Discretization/Cells = 8",
    "Discretization/Mesh size = 0"};
  EXPECT_EQ(cases[0].settings, expected);
}

TEST(StudyCases, refuses_the_same_case_twice)
{
  Parameters p;
  p.study.cells = "2, 02";
  EXPECT_THROW(study_cases(p), BadInput);
  p.study.cells   = "2, 3";
  p.study.methods = "tetrahedra, tetrahedra 2";
  p.study.degrees = "1, 2";
  EXPECT_THROW(study_cases(p), BadInput);
  p.study.degrees = "1";
  EXPECT_EQ(study_cases(p).size(), 4u);
}

TEST(StudyCases, refuses_levels_that_no_method_has)
{
  Parameters p;
  p.study.cut_levels = "1, 2";
  p.study.methods    = "sparse grid, hexahedra";
  EXPECT_THROW(study_cases(p), BadInput);
  p.study.methods = "sparse grid, weighted cell";
  EXPECT_EQ(study_cases(p).size(), 3u);
}

TEST(StudyCases, of_nothing_is_one_case)
{
  Parameters p;
  p.discretization.method = "weighted cell";

  const std::vector<StudyCase> cases = study_cases(p);
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].name, "weighted_cell");
  EXPECT_TRUE(cases[0].settings.empty());
}

TEST(StudyCases, combine_sweeps_with_lists_and_remember_labels)
{
  Parameters p;
  p.study.cells = "4, 8";
  p.sweeps = {{"tissue", "soft: Material / Young modulus = 500 ; Solver/Load steps = 4 | as is: | "
                         "half: Regions/base = x < 0 || y < 0"},
              {"solver", "CG: | direct: Solver/Linear solver = direct"}};

  const std::vector<StudyCase> cases = study_cases(p);
  ASSERT_EQ(cases.size(), 12u);
  EXPECT_EQ(cases[1].name, "weighted_cell_n8_soft_CG");
  EXPECT_EQ(cases[7].name, "weighted_cell_n8_as_is_direct");
  const std::vector<std::pair<std::string, std::string>> labels = {{"tissue", "as is"},
                                                                   {"solver", "direct"}};
  EXPECT_EQ(cases[7].labels, labels);
  const std::vector<std::string> settings = {
    "Material/Young modulus = 500", "Solver/Load steps = 4", "Solver/Linear solver = direct",
    "Discretization/Cells = 4", "Discretization/Cell size = 0"};
  EXPECT_EQ(cases[2].settings, settings);
  // A reference for every body, material and load, but not for every solver.
  EXPECT_EQ(cases[2].problem_settings, std::vector<std::string>{"Material/Young modulus = 500"});
  EXPECT_EQ(cases[2].problem, "_soft");
  EXPECT_EQ(cases[7].problem, "");
  EXPECT_EQ(cases[9].problem_settings, std::vector<std::string>{"Regions/base = x < 0 || y < 0"});
}

TEST(StudyCases, take_levels_and_names_from_the_method_that_is_swept)
{
  Parameters p;
  p.study.cut_levels = "1, 2";
  p.sweeps           = {{"rule", "a: Discretization/Method = sparse grid | b:"}};

  std::vector<std::string> names;
  for (const StudyCase &one : study_cases(p))
    names.push_back(one.name);
  const std::vector<std::string> expected = {"sparse_grid_a", "weighted_cell_l1_b",
                                             "weighted_cell_l2_b"};
  EXPECT_EQ(names, expected);
}
