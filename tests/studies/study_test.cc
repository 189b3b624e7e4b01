// SPDX-License-Identifier: LGPL-2.1-or-later
// The cases that a study makes of its lists.

#include <softcell/base/exceptions.h>
#include <softcell/studies/study.h>

#include <gtest/gtest.h>

namespace
{
  using namespace softcell;
}

TEST(Study, combines_what_is_swept_and_gives_levels_only_to_cut_methods)
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

TEST(Study, settings_say_what_tells_a_case_from_the_others)
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

TEST(Study, refuses_the_same_case_twice)
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

TEST(Study, refuses_levels_that_no_method_has)
{
  Parameters p;
  p.study.cut_levels = "1, 2";
  p.study.methods    = "sparse grid, hexahedra";
  EXPECT_THROW(study_cases(p), BadInput);
  p.study.methods = "sparse grid, weighted cell";
  EXPECT_EQ(study_cases(p).size(), 3u);
}

TEST(Study, of_nothing_is_one_case)
{
  Parameters p;
  p.discretization.method = "weighted cell";

  const std::vector<StudyCase> cases = study_cases(p);
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].name, "weighted_cell");
  EXPECT_TRUE(cases[0].settings.empty());
}
