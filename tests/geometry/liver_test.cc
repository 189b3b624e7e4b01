// SPDX-License-Identifier: LGPL-2.1-or-later
// A body of voxels from a real liver.

#include <softcell/base/exceptions.h>
#include <softcell/geometry/image_body.h>

#include <gtest/gtest.h>

#include <fstream>

using namespace softcell;

namespace
{
  /// Where the liver is in this format, or, as liver.inr.gz, where scripts/fetch-liver puts it.
  std::string liver_file(const std::string &name)
  {
    const std::string file = SOFTCELL_ORGANS "/liver_cgal/" + name;
    return std::ifstream(file) || name != "liver.inr.gz" ? file : SOFTCELL_LIVER;
  }
} // namespace

class Liver : public ::testing::TestWithParam<const char *>
{
};

TEST_P(Liver, IsTheSameFromEachFormat)
{
  const std::string file = liver_file(GetParam());
  if (!std::ifstream(file))
    GTEST_SKIP() << file << " is missing";
  std::vector<std::string> remarks;
  const ImageBody liver(read_image(file, 0.001), {255}, file, remarks);
  EXPECT_NEAR(liver.volume(), 1605.195e-6, 1e-9);
  EXPECT_TRUE(remarks.empty());
  const auto [low, high] = liver.bounding_box().get_boundary_points();
  EXPECT_LT(low.distance(Point(0.0334, 0.0233, 0.0455)), 0.003); // of the surface in liver_20k.stl
  EXPECT_LT(high.distance(Point(0.2385, 0.1948, 0.1954)), 0.003);
  EXPECT_TRUE(liver.contains(Point(0.1, 0.1, 0.12)));
}

INSTANTIATE_TEST_SUITE_P(
  Formats,
  Liver,
  ::testing::Values("liver.inr.gz", "liver_seg.nrrd", "liver_seg.nii.gz", "liver_seg.mhd"));

TEST(ImageBody, SurfaceOfTheLiver)
{
  const std::string file = liver_file("liver.inr.gz");
  if (!std::ifstream(file))
    GTEST_SKIP() << file << " is missing";
  std::vector<std::string> remarks;
  const ImageBody liver(read_image(file, 0.001), {255}, file, remarks);
  const Surface &surface = liver.surface();
  EXPECT_NEAR(surface.volume() / liver.volume(), 1, 1e-4);
  EXPECT_NEAR(surface.area(), 850e-4, 20e-4); // of surfaces made by others, see the data's README
  EXPECT_GT(surface.triangles().size(), 50000u);
  EXPECT_LT(surface.triangles().size(), 120000u);
  double smallest = 1;
  for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    smallest = std::min(smallest, surface.area(t));
  EXPECT_GT(smallest, 0);
}
