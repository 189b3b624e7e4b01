// SPDX-License-Identifier: LGPL-2.1-or-later
// The section Geometry: what a user writes becomes the body that is meant, or a sentence that
// helps.

#include <softcell/base/exceptions.h>
#include <softcell/geometry/geometry.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

#include "shapes.h"
#include "surface_files.h"

#include <cmath>

using namespace softcell;
using namespace softcell::testing;

namespace
{
  GeometryParameters parse(const std::string &entries)
  {
    GeometryParameters parameters;
    dealii::ParameterHandler prm;
    prm.enter_subsection("Geometry");
    parameters.add_parameters(prm);
    prm.leave_subsection();
    prm.parse_input_from_string("subsection Geometry\n" + entries + "end\n");
    return parameters;
  }

  std::unique_ptr<Body> body(const std::string &entries)
  {
    std::vector<std::string> remarks;
    return make_body(parse(entries), remarks);
  }

  void expect_bad_input(const std::string &entries, const std::string &hint)
  {
    try
    {
      body(entries);
      ADD_FAILURE() << "accepted: " << entries;
    }
    catch (const BadInput &e)
    {
      EXPECT_NE(std::string(e.what()).find(hint), std::string::npos) << e.what();
    }
  }
} // namespace

TEST(Geometry, MakesEveryShape)
{
  const double pi = std::acos(-1.);
  EXPECT_NEAR(body("set Type = box\n set Size = 2, 3, 4\n")->volume(), 24, 1e-12);
  EXPECT_NEAR(body("set Type = cylinder\n set Radius = 2\n set Length = 3\n")->volume(), 12 * pi,
              1e-12);
  EXPECT_NEAR(body("set Type = sphere\n set Radius = 3\n")->volume(), 36 * pi, 1e-12);
  EXPECT_NEAR(body("set Type = hollow sphere\n set Radius = 3\n set Inner radius = 1\n")->volume(),
              104 * pi / 3, 1e-12);
  EXPECT_NEAR(body("set Type = torus\n set Radius = 1\n set Ring radius = 3\n")->volume(),
              6 * pi * pi, 1e-12);
  EXPECT_NEAR(body("set Type = hexagonal prism\n set Radius = 2\n set Length = 3\n")->volume(),
              18 * std::sqrt(3.), 1e-12);
}

TEST(Geometry, ReadsASurfaceInItsUnit)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("brick.off", as_off(brick(Point(), Point(20, 30, 40))));
  EXPECT_NEAR(body("set Type = surface\n set File = " + file + "\n set Scale = 0.001\n")->volume(),
              24e-6, 1e-15);
}

TEST(Geometry, ReadsListsOfLabels)
{
  EXPECT_TRUE(parse("").labels.empty());
  EXPECT_EQ(parse("set Labels = 85, 255\n").labels, std::vector<unsigned int>({85, 255}));
}

TEST(Geometry, RefusesSizesThatAreNone)
{
  expect_bad_input("set Type = sphere\n set Radius = 0\n", "Geometry/Radius = 0");
  expect_bad_input("set Type = cylinder\n set Length = 0\n", "Geometry/Length = 0");
  expect_bad_input("set Type = hexagonal prism\n set Radius = 0\n", "Geometry/Radius = 0");
  expect_bad_input("set Type = box\n set Size = 1, 0, 1\n", "Size (y) = 0");
  expect_bad_input("set Type = torus\n set Radius = 0.2\n set Ring radius = 0.1\n",
                   "larger Ring radius");
  expect_bad_input("set Type = hollow sphere\n set Radius = 0.2\n set Inner radius = 0.2\n",
                   "give a smaller one");
  expect_bad_input("set Type = surface\n set File = liver.stl\n set Scale = 0\n",
                   "Geometry/Scale = 0");
  GeometryParameters parameters;
  parameters.type   = "sphere";
  parameters.radius = std::nan("");
  std::vector<std::string> remarks;
  EXPECT_THROW(make_body(parameters, remarks), BadInput);
}

TEST(Geometry, AsksForWhatIsMissing)
{
  expect_bad_input("set Type = surface\n", "Geometry/File is empty");
  GeometryParameters parameters;
  parameters.type = "cone";
  std::vector<std::string> remarks;
  EXPECT_THROW(make_body(parameters, remarks), BadInput);
}

TEST(Geometry, RemarksOnAUnitThatSeemsWrong)
{
  const TemporaryFolder folder;
  const auto n_remarks = [&folder](const double edge, const std::string &scale) {
    const auto box         = make_box(Point(edge, edge, edge));
    const std::string file = folder.write("unit.off", as_off(box->surface()));
    std::vector<std::string> remarks;
    make_body(parse("set Type = surface\n set File = " + file + "\n" + scale), remarks);
    return remarks.size();
  };
  EXPECT_EQ(n_remarks(120, ""), 1u);
  EXPECT_EQ(n_remarks(120, "set Scale = 0.001\n"), 0u);
  EXPECT_EQ(n_remarks(0.1, ""), 0u);
  EXPECT_EQ(n_remarks(1e-5, ""), 1u);
}
