// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies of voxels: exact volumes, labels, stray pieces and the smooth surface.

#include <softcell/base/exceptions.h>
#include <softcell/geometry/image_body.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace softcell;

namespace
{
  /// An image of 12 x 10 x 8 voxels of 1 x 2 x 3 m with its lower corner at (5, 6, 7); the label of
  /// each voxel is what `label` says of its indices.
  template <class Label>
  LabelImage small_image(const Label &label)
  {
    LabelImage image;
    image.size    = {{12, 10, 8}};
    image.origin  = Point(5.5, 7, 8.5);
    image.spacing = Direction({1, 2, 3});
    image.values  = {0, 1, 2, 40, 255};
    for (unsigned int k = 0; k < 8; ++k)
      for (unsigned int j = 0; j < 10; ++j)
        for (unsigned int i = 0; i < 12; ++i)
        {
          const auto found = std::find(image.values.begin(), image.values.end(), label(i, j, k));
          image.voxels.push_back(found - image.values.begin());
        }
    return image;
  }

  /// Two labels with a bumpy border, random inside, away from the image's rim along x only.
  unsigned int bumpy(const unsigned int i, const unsigned int j, const unsigned int k)
  {
    return i < 1 || i > 10 || (i * 7 + j * 5 + k * 3) % 11 == 0 ? 0 : (i + j < 9 ? 255 : 40);
  }

  /// Four labels in bricks without a gap.
  unsigned int bricks(const unsigned int i, const unsigned int j, const unsigned int k)
  {
    return std::array<unsigned int, 4>{{1, 2, 40, 255}}[(i / 3 + 2 * (j / 4) + k / 2) % 4];
  }

  ImageBody body(LabelImage image, const std::vector<unsigned int> &labels = {})
  {
    std::vector<std::string> remarks;
    return ImageBody(std::move(image), labels, "test.inr", remarks);
  }

  /// Volume of the box's intersections with the voxels of each value, one by one.
  std::array<double, 5> voxel_by_voxel(const LabelImage &image, const Box &box)
  {
    std::array<double, 5> volumes = {};
    for (std::size_t v = 0; v < image.voxels.size(); ++v)
    {
      const std::array<std::size_t, 3> index = {{v % 12, v / 12 % 10, v / 120}};
      double part                            = 1;
      for (unsigned int d = 0; d < dim; ++d)
      {
        const double low = image.origin[d] + (index[d] - 0.5) * image.spacing[d];
        part *= overlap(box, d, low, low + image.spacing[d]);
      }
      volumes[image.voxels[v]] += part;
    }
    return volumes;
  }
} // namespace

TEST(ImageBody, IsExactForAnyBox)
{
  for (const LabelImage &image : {small_image(bumpy), small_image(bricks)})
  {
    const ImageBody voxels = body(image);
    std::mt19937 random(3);
    std::uniform_real_distribution<> unit(-0.1, 1.1), size(-4, 0);
    EXPECT_NEAR(voxels.volume(),
                6 * (960 - std::count(image.voxels.begin(), image.voxels.end(), 0)), 1e-10);
    for (unsigned int trial = 0; trial < 300; ++trial)
    {
      const Point low(5 + 12 * unit(random), 6 + 20 * unit(random), 7 + 24 * unit(random));
      const Direction sides({12 * std::pow(10, size(random)), 20 * std::pow(10, size(random)),
                             24 * std::pow(10, size(random))});
      const Box box({low, low + sides});
      const auto expected = voxel_by_voxel(image, box);
      const double filled = std::accumulate(expected.begin() + 1, expected.end(), 0.);
      EXPECT_NEAR(voxels.filled_volume(box), filled, 1e-10 * box.volume());

      const double of_one_label = *std::max_element(expected.begin() + 1, expected.end());
      EXPECT_EQ(voxels.classify(box), of_one_label > (1 - 1e-9) * box.volume() ? Side::inside
                                      : filled < 1e-9 * box.volume()           ? Side::outside
                                                                               : Side::cut);
    }
  }
}

TEST(ImageBody, BoxesFlushWithVoxelsAreNotCut)
{
  const ImageBody block =
    body(small_image([](unsigned int i, unsigned int, unsigned int) { return i < 6 ? 255 : 0; }));
  EXPECT_EQ(block.bounding_box(), Box({Point(5, 6, 7), Point(11, 26, 31)}));
  EXPECT_EQ(block.volume(), 6 * 20 * 24);
  EXPECT_EQ(block.classify(block.bounding_box()), Side::inside);
  EXPECT_EQ(block.classify(Box({Point(11, 6, 7), Point(12, 7, 8)})), Side::outside);
  EXPECT_EQ(block.classify(Box({Point(10.9, 6, 7), Point(11.1, 7, 8)})), Side::cut);
  EXPECT_EQ(block.classify(Box({Point(10, 5, 7), Point(10.5, 7, 8)})), Side::cut);
  EXPECT_TRUE(block.contains(Point(10.9, 6.1, 7.1)));
  EXPECT_FALSE(block.contains(Point(11.1, 6.1, 7.1)));
  EXPECT_FALSE(block.contains(Point(10.9, 5.9, 7.1)));

  const ImageBody stack = body(small_image(bricks)); // of bricks of 3 x 8 x 6 m
  EXPECT_EQ(stack.classify(Box({Point(8, 14, 13), Point(11, 22, 19)})), Side::inside);
  EXPECT_EQ(stack.classify(Box({Point(8, 14, 13), Point(11.1, 22, 19)})), Side::cut);
}

TEST(ImageBody, LabelsAreCountedAsChosen)
{
  const ImageBody both = body(small_image(bumpy));
  ASSERT_EQ(both.n_labels(), 2u);
  EXPECT_EQ(both.label_name(0), "40");
  EXPECT_EQ(both.label_name(1), "255");
  EXPECT_EQ(both.label(Point(6.5, 7, 11.5)), 1u);   // voxel (1, 0, 1)
  EXPECT_EQ(both.label(Point(15.5, 25, 11.5)), 0u); // voxel (10, 9, 1)
  EXPECT_EQ(both.label(Point(2, 2, 2)), 1u);        // outside, near the first corner

  const ImageBody turned = body(small_image(bumpy), {255, 40});
  EXPECT_EQ(turned.label_name(0), "255");
  EXPECT_EQ(turned.label(Point(6.5, 7, 11.5)), 0u);
  EXPECT_EQ(turned.volume(), both.volume());

  const ImageBody one = body(small_image(bumpy), {255});
  EXPECT_EQ(one.n_labels(), 1u);
  EXPECT_TRUE(one.contains(Point(6.5, 7, 11.5)));
  EXPECT_FALSE(one.contains(Point(15.5, 25, 11.5)));
}

TEST(ImageBody, AbsentLabelsAreNamedWithThoseThatExist)
{
  try
  {
    body(small_image([](unsigned int i, unsigned int, unsigned int) { return i == 0 ? 40 : 0; }),
         {7});
    FAIL() << "accepted";
  }
  catch (const BadInput &e)
  {
    EXPECT_NE(std::string(e.what()).find("label 7"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("40 (80 voxels)"), std::string::npos) << e.what();
  }
  EXPECT_THROW(body(small_image([](unsigned int, unsigned int, unsigned int) { return 0; })),
               BadInput);
  EXPECT_THROW(body(small_image(bumpy), {40, 40}), BadInput);
}

TEST(ImageBody, StrayVoxelsAreLeftOut)
{
  LabelImage image;
  image.size    = {{40, 40, 2}};
  image.spacing = Direction({1, 1, 1});
  image.values  = {0, 1};
  image.voxels.assign(3200, 1);
  for (unsigned int v = 0; v < 3200; ++v)
    if (v % 40 == 20)
      image.voxels[v] = 0; // two plates
  LabelImage specked = image;
  for (unsigned int v = 0; v < 3200; ++v)
    if (v % 40 > 20)
      specked.voxels[v] = v == 39;
  std::vector<std::string> remarks;
  EXPECT_EQ(ImageBody(specked, {}, "specks", remarks).volume(), 1600);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_NE(remarks[0].find("1 stray voxel"), std::string::npos) << remarks[0];

  remarks.clear();
  EXPECT_EQ(ImageBody(image, {}, "plates", remarks).volume(), 3120);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_NE(remarks[0].find("2 pieces"), std::string::npos) << remarks[0];
}

/// A ball with a hollow: the surface has both, is closed, and encloses what the voxels fill.
TEST(ImageBody, SurfaceIsClosedSmoothAndKeepsTheVolume)
{
  const Point centre(20, 20, 20);
  LabelImage image;
  image.size    = {{50, 50, 40}};
  image.origin  = Point(0.4, 0.4, 0.5);
  image.spacing = Direction({0.8, 0.8, 1});
  image.values  = {0, 1};
  for (unsigned int v = 0; v < 100000; ++v)
  {
    const double r =
      centre.distance(Point(0.4 + v % 50 * 0.8, 0.4 + v / 50 % 50 * 0.8, 0.5 + v / 2500));
    image.voxels.push_back(r < 18 && r > 9);
  }
  const ImageBody ball   = body(image);
  const Surface &surface = ball.surface();
  EXPECT_NEAR(surface.volume() / ball.volume(), 1, 1e-3);
  // The Gaussian, sigma = 1.5, moves a sphere inwards by sigma^2 / R, and the level that restores
  // the volume both away from the body by 0.05: radii of 17.925 and 8.7.
  EXPECT_NEAR(surface.area() / (4 * std::acos(-1.) * (18 * 18 + 9 * 9)), 0.98, 0.005);

  Direction normals;
  unsigned int n_inner = 0;
  for (unsigned int t = 0; t < surface.triangles().size(); ++t)
  {
    EXPECT_GT(surface.area(t), 0);
    normals += surface.area(t) * surface.normal(t);
    const Direction radial = surface.corners(t)[0] - centre;
    const bool inner       = radial.norm() < 13;
    EXPECT_GT((inner ? -1 : 1) * (surface.normal(t) * radial) / radial.norm(), 0.85);
    n_inner += inner;
  }
  EXPECT_LT(normals.norm(), 1e-10 * surface.area());
  EXPECT_GT(n_inner, 100u);
  for (const Point &X : surface.vertices())
    EXPECT_LT(std::min(std::abs(centre.distance(X) - 18), std::abs(centre.distance(X) - 9)), 0.5);
}
