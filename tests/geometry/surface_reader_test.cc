// SPDX-License-Identifier: LGPL-2.1-or-later
// Surface files of every format: what they give, and that a broken one is an error.

#include <softcell/base/exceptions.h>

#include <gtest/gtest.h>

#include "shapes.h"
#include "surface_files.h"

using namespace softcell;
using namespace softcell::testing;

namespace
{
  using Names = std::vector<std::string>;

  std::string read_error(const std::string &file)
  {
    std::vector<std::string> repairs;
    try
    {
      read_surface(file, 1, repairs);
    }
    catch (const BadInput &error)
    {
      return error.what();
    }
    return "no error";
  }

  /// Writes the surface in each format; returns the files.
  Names write_all(const TemporaryFolder &folder, const Surface &surface)
  {
    write_vtp(folder.path("xml.vtp"), surface, {});
    return {folder.write("a.off", as_off(surface)),
            folder.write("a.obj", as_obj(surface)),
            folder.write("text.stl", as_stl_text(surface)),
            folder.write("binary.STL", as_stl_binary(surface)),
            folder.write("text.ply", as_ply(surface, "ascii")),
            folder.write("little.ply", as_ply(surface, "binary_little_endian")),
            folder.write("big.ply", as_ply(surface, "binary_big_endian")),
            folder.path("xml.vtp")};
  }
} // namespace

TEST(SurfaceReader, EveryFormatGivesTheSameSurfaceInMetres)
{
  const TemporaryFolder folder;
  const Surface ball = sphere(2, 50, Point(10, 20, -30));
  for (const std::string &file : write_all(folder, ball))
  {
    SCOPED_TRACE(file);
    std::vector<std::string> repairs;
    const Surface read = read_surface(file, 0.001, repairs);
    EXPECT_EQ(repairs, Names());
    ASSERT_EQ(read.vertices().size(), ball.vertices().size());
    ASSERT_EQ(read.triangles().size(), ball.triangles().size());
    EXPECT_EQ(read.patches(), ball.patches());
    EXPECT_NEAR(read.volume() / (1e-9 * ball.volume()), 1, 1e-6);
    EXPECT_NEAR(read.area() / (1e-6 * ball.area()), 1, 1e-6);
    for (unsigned int t = 0; t < ball.triangles().size(); ++t)
      EXPECT_LT((read.normal(t) - ball.normal(t)).norm(), 1e-5);
  }
}

TEST(SurfaceReader, TruncatedFilesAreErrors)
{
  const TemporaryFolder folder;
  for (const std::string &file : write_all(folder, sphere(1)))
  {
    std::ifstream stream(file, std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(stream)),
                              std::istreambuf_iterator<char>());
    for (unsigned int i = 1; i < 40; ++i)
    {
      folder.write(std::filesystem::path(file).filename(),
                   content.substr(0, content.size() * i / 40));
      EXPECT_EQ(read_error(file).rfind(file + ": ", 0), 0u)
        << read_error(file) << " at part " << i << " of 40";
    }
  }
}

TEST(SurfaceReader, PatchesComeFromSolidsGroupsAndCellData)
{
  const TemporaryFolder folder;
  const Surface cube = brick();
  write_vtp(folder.path("cube.vtp"), cube, {{"displacement", std::vector<Direction>(8)}});
  for (const std::string &file : {folder.write("cube.stl", as_stl_text(cube)),
                                  folder.write("cube.obj", as_obj(cube)), folder.path("cube.vtp")})
  {
    std::vector<std::string> repairs;
    const Surface read = read_surface(file, 1, repairs);
    ASSERT_EQ(read.triangles().size(), 12u);
    for (unsigned int t = 0; t < 12; ++t)
    {
      const unsigned int patch = read.patches()[t];
      ASSERT_LT(patch, 6u);
      EXPECT_EQ(read.normal(t)[patch % 3], patch < 3 ? -1 : 1) << file;
    }
  }
}

TEST(SurfaceReader, FilesThatAreNoSurfaceAreNamed)
{
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string &name, const std::string &content) {
    const std::string file = folder.write(name, content), error = read_error(file);
    EXPECT_EQ(error.rfind(file + ": ", 0), 0u) << error;
    return error;
  };
  const auto expect_in = [](const std::string &part, const std::string &error) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  expect_in("there is no such file", read_error(folder.path("missing.stl")));
  expect_in("is a folder", read_error(folder.path("")));
  expect_in("is empty", error_of("empty.stl", ""));
  expect_in("unknown ending '.jpg'", error_of("picture.jpg", "abc"));
  expect_in("unknown ending ''", error_of("none", "abc"));
  expect_in("expected 'OFF' but found 'COFF'", error_of("colours.off", "COFF\n1 1 0\n"));
  expect_in("line 3: expected a number but found 'one'",
            error_of("word.off", "OFF\n1 1 0\n0 one 2\n"));
  expect_in("no triangles but 1 point", error_of("points.off", "OFF\n1 0 0\n0 1 2\n"));
  expect_in("expected a count", error_of("negative.off", "OFF\n-1 1 0\n"));
  expect_in("polygon 0 (from 0) uses point 9 but the file has only 1",
            error_of("index.off", "OFF\n1 1 0\n0 1 2\n3 0 9 0\n"));
  expect_in("has only 2 corners", error_of("line.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n"));
  expect_in("number of a point but found '0'", error_of("zero.obj", "v 0 0 0\nf 0 1 2\n"));
  expect_in("neither a text STL", error_of("short.stl", std::string(50, 'x')));
  expect_in("room for 0", error_of("noise.stl", std::string(90, 'x')));
  expect_in("unknown format 'binary'", error_of("format.ply", "ply\nformat binary 1.0\n"));
  expect_in("unknown header entry 'elephant'",
            error_of("header.ply", "ply\nformat ascii 1.0\nelephant 3\n"));
  expect_in("VTK cannot read it", error_of("other.vtp", as_off(tetrahedron())));

  for (const std::string value : {"nan", "inf", "-1e999"})
  {
    std::string text = as_off(tetrahedron());
    text.replace(text.find("\n1 0 0\n"), 7, "\n1 " + value + " 0\n");
    expect_in("1 point has a coordinate that is NaN or infinite, the first is point 1",
              error_of("nan.off", text));
  }
}
