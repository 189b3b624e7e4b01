// SPDX-License-Identifier: LGPL-2.1-or-later
// The section Loads.

#include "../box_of_cells.h"
#include "../box_surface.h"

#include <softcell/base/exceptions.h>
#include <softcell/loads/load_list.h>
#include <softcell/loads/supports.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    using Entries = std::vector<std::pair<std::string, std::string>>;

    /// What stands on the lattice's unit cube.
    struct Problem
    {
      std::vector<Region> regions;
      Surface surface = box_surface(Point(1, 1, 1), 2);
      std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3, 1000)};
      LoadParameters parameters;

      Problem()
      {
        regions.emplace_back("base", "nz < -0.5");
        regions.emplace_back("top", "nz > 0.5");
        regions.emplace_back("nothing", "z > 7");
      }

      Loads loads(const BoxOfCells &body, const Entries &entries) const
      {
        return make_loads(parameters, parse_loads(entries, regions), regions, body, surface,
                          materials);
      }

      std::string complaint(const BoxOfCells &body, const Entries &entries) const
      {
        try
        {
          loads(body, entries);
        }
        catch (const BadInput &error)
        {
          return error.what();
        }
        return "";
      }
    };

    bool says(const std::string &text, const std::string &part)
    {
      return text.find(part) != std::string::npos;
    }

    BoxOfCells unit_cube(const bool is_fitted)
    {
      return BoxOfCells({2, 2, 4}, Point(1, 1, 1), MPI_COMM_WORLD, is_fitted);
    }
  } // namespace

  TEST(LoadList, ReadsSeveralLoadsOfARegion)
  {
    const Problem problem;
    const auto loads = parse_loads(
      {{"base", "clamp"}, {"top", "traction 0,0,1; pressure max(5, x)"}}, problem.regions);
    ASSERT_EQ(loads.size(), 3u);
    EXPECT_EQ(loads[0].kind, LoadDescription::Kind::displacement);
    EXPECT_EQ(loads[0].value, "0, 0, 0");
    EXPECT_EQ(loads[1].region, "top");
    EXPECT_EQ(loads[2].kind, LoadDescription::Kind::pressure);
    EXPECT_EQ(loads[2].value, "max(5, x)");
    EXPECT_EQ(loads[2].place, "Loads/top = 'pressure max(5, x)'");
  }

  TEST(LoadList, BuildsForcesAndStrongDisplacements)
  {
    Problem problem;
    problem.parameters.gravity = Direction({0, 0, -10});
    const BoxOfCells body      = unit_cube(true);
    const Loads loads = problem.loads(body, {{"base", "clamp"}, {"top", "traction 0, -30, 0"}});
    EXPECT_EQ(loads.free_motions, "");
    EXPECT_EQ(loads.imposed.regions(), std::vector<std::string>{"base"});
    ASSERT_EQ(loads.forces.size(), 2u);
    const Vector u = body.make_vector();
    EXPECT_LT((loads.forces[0]->total_force(u, 1) - Direction({0, 0, -10000})).norm(), 1e-8);
    EXPECT_LT((loads.forces[1]->total_force(u, 1) - Direction({0, -30, 0})).norm(), 1e-10);
  }

  TEST(LoadList, ChoosesHowToImposeADisplacement)
  {
    Problem problem;
    const BoxOfCells grid = unit_cube(false);
    const Entries entries{{"base", "displacement 0, 0, 0.1"}};
    const Vector u = grid.make_vector();

    const Loads automatic = problem.loads(grid, entries);
    EXPECT_TRUE(dynamic_cast<const Penalty *>(automatic.forces.at(0).get()));
    EXPECT_EQ(automatic.free_motions, "");

    problem.parameters.imposition = "strong";
    EXPECT_TRUE(says(problem.complaint(grid, entries), "region 'base'"));

    problem.parameters.imposition = "penalty";
    const double modulus = problem.materials[0].longitudinal_modulus(); // on cells of 1/4 m
    EXPECT_NEAR(problem.loads(grid, entries).forces.at(0)->total_force(u, 1)[2],
                10 * modulus / 0.25 * 0.1, 1e-8 * modulus);
    problem.parameters.penalty = "100*10^t";
    EXPECT_NEAR(problem.loads(grid, entries).forces.at(0)->total_force(u, 1)[2], 100, 1e-10);

    problem.parameters.penalty = "-1e8";
    EXPECT_TRUE(says(problem.complaint(grid, entries), "Loads/Penalty = '-1e8' is negative at"));
    problem.parameters.penalty             = "100*10^t";
    problem.parameters.surface_integration = "nodal"; // 3 x 3 nodes of 1000 N/m
    EXPECT_NEAR(problem.loads(grid, entries).forces.at(0)->total_force(u, 1)[2], 900, 1e-10);
    problem.parameters.imposition = "Nitsche";
    EXPECT_TRUE(says(problem.complaint(grid, entries), "nodal has no Nitsche"));
    problem.parameters.imposition = "automatic";
    problem.parameters.penalty    = "automatic";
    EXPECT_TRUE(says(problem.complaint(grid, entries), "Loads/Penalty = 'automatic' knows no"));
  }

  TEST(LoadList, KnowsWhatHoldsTheBody)
  {
    const Problem problem;
    const BoxOfCells body = unit_cube(true), grid = unit_cube(false);
    EXPECT_TRUE(says(problem.loads(body, {{"top", "traction 0, 0, 1"}}).free_motions,
                     "free to move along x, y and z and"));
    EXPECT_EQ(problem.loads(grid, {{"top", "springs 1e6"}}).free_motions, "");
    EXPECT_NE(problem.loads(grid, {{"top", "springs 0"}}).free_motions, "");
    for (const BoxOfCells *any : {&body, &grid})
      EXPECT_TRUE(says(problem.loads(*any, {{"base", "displacement free, free, 0"}}).free_motions,
                       "free to move along x and y and to turn about z"));
  }

  TEST(LoadList, WarnsOfLoadsThatDoNothing)
  {
    Problem problem;
    problem.regions.emplace_back("low", "z < 0.3");
    for (const bool is_fitted : {true, false})
    {
      const BoxOfCells body = unit_cube(is_fitted);
      const auto warning    = [&](const Entries &entries) {
        const std::vector<std::string> warnings = problem.loads(body, entries).warnings;
        return warnings.empty() ? "" : warnings[0];
      };
      EXPECT_TRUE(says(warning({{"base", "clamp"}}), "Nothing acts on the body"));
      EXPECT_EQ(warning({{"base", "clamp"}, {"top", "traction 0, 0, 1"}}), "");
      EXPECT_EQ(warning({{"base", "clamp"}, {"top", "displacement 0, 0, 0.1"}}), "");
      EXPECT_TRUE(says(warning({{"base", "clamp; traction 0, 0, 1"}}),
                       "Loads/base = 'traction 0, 0, 1' deforms nothing"));
      EXPECT_EQ(warning({{"base", "clamp"}, {"low", "pressure 5"}}), ""); // reaches beyond it
      EXPECT_EQ(warning({{"base", "displacement free, 0, 0; traction 1, 0, 0"}}), "");
    }
    problem.parameters.gravity = Direction({0, 0, -10});
    EXPECT_TRUE(problem.loads(unit_cube(true), {{"base", "clamp"}}).warnings.empty());
  }

  TEST(LoadList, RefusesToHoldAPointInTwoPlaces)
  {
    Problem problem;
    problem.regions.emplace_back("lower", "z < 0.3");
    const BoxOfCells grid = unit_cube(false);
    for (const std::string how : {"penalty", "Nitsche"})
    {
      problem.parameters.imposition = how;
      const std::string text =
        problem.complaint(grid, {{"base", "clamp"}, {"lower", "displacement free, 0, 0.1"}});
      EXPECT_TRUE(says(text, "Loads/base = 'clamp' and Loads/lower = 'displacement free, 0, 0.1' "
                             "impose 0 m and 0.1 m along z at ("))
        << text;
      EXPECT_EQ(problem.complaint(grid, {{"base", "clamp"}, {"lower", "displacement 0, 0, free"}}),
                "");
      EXPECT_EQ(problem.complaint(grid, {{"base", "clamp"}, {"top", "displacement 0, 0, 0.1"}}),
                "");
    }
  }

  TEST(LoadList, NamesWhatIsWrong)
  {
    const Problem problem;
    const BoxOfCells body = unit_cube(true);
    const auto says_of    = [&](const std::string &region, const std::string &text) {
      return problem.complaint(body, {{region, text}});
    };
    EXPECT_TRUE(says(says_of("base", "clmp"), "Loads/base = 'clmp'"));
    EXPECT_TRUE(says(says_of("base", "clmp"), "did you mean 'clamp'?"));
    EXPECT_TRUE(says(says_of("basis", "clamp"), "it has base, top, nothing"));
    EXPECT_TRUE(says(says_of("bas", "clamp"), "did you mean 'base'?"));
    EXPECT_TRUE(says(says_of("base", "clamp 1"), "a clamp takes none"));
    EXPECT_TRUE(says(says_of("top", "traction 1, 2"), "has 2 components"));
    EXPECT_TRUE(says(says_of("top", "traction free, 0, 0"), "only a displacement may have"));
    EXPECT_TRUE(says(says_of("top", "displacement free, free, free"), "every component free"));
    EXPECT_TRUE(says(says_of("top", "traction 0, x = 3, 0"), "'==' does"));
    EXPECT_TRUE(says(says_of("base", "springs 0.5 - x"), "is negative at"));
    EXPECT_TRUE(says(says_of("top", "pressure 1/(x-x)"), "not a finite number at"));
    EXPECT_TRUE(says(says_of("top", "pressure log(t - 0.35)"), "t = 0.1;"));
    EXPECT_TRUE(says(says_of("top", ""), "is empty"));
    EXPECT_TRUE(says(says_of("nothing", "clamp"), "Regions/nothing selects nothing"));
    EXPECT_TRUE(says(says_of("nothing", "pressure 1"), "Regions/nothing selects nothing"));
  }

  TEST(LoadList, DeclaresItsEntries)
  {
    LoadParameters parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    prm.set("Gravity", "0, 0, -9.81");
    prm.set("Imposed displacement", "Nitsche");
    prm.parse_input_from_string("set Nitsche factor = 20");
    EXPECT_EQ(parameters.gravity, Direction({0, 0, -9.81}));
    EXPECT_EQ(parameters.imposition, "Nitsche");
    EXPECT_EQ(parameters.nitsche_factor, 20);
    EXPECT_THROW(prm.set("Surface integration", "rough"), std::exception);
  }
} // namespace softcell
