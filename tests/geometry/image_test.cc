// SPDX-License-Identifier: LGPL-2.1-or-later
// Reading segmentations: every format gives the same voxels, and every kind of broken file is
// refused in words.

#include "image_files.h"

#include <softcell/base/exceptions.h>
#include <softcell/geometry/image.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>
#include <zlib.h>

using namespace softcell;

namespace
{
  /// A folder of files that goes with the test.
  class Image : public ::testing::Test
  {
  protected:
    Image()
        : folder_(std::filesystem::temp_directory_path() /
                  ("softcell_image_" + std::to_string(getpid())))
    {
      std::filesystem::create_directory(folder_);
    }

    ~Image() override
    {
      std::filesystem::remove_all(folder_);
    }

    std::string write(const std::string &name, const std::string &content) const
    {
      std::ofstream(folder_ / name, std::ios::binary) << content;
      return folder_ / name;
    }

    std::string write_gzip(const std::string &name, const std::string &content) const
    {
      const std::string file = folder_ / name;
      const gzFile out       = gzopen(file.c_str(), "wb");
      gzwrite(out, content.data(), content.size());
      gzclose(out);
      return file;
    }

    std::string gzipped(const std::string &content) const
    {
      std::ifstream in(write_gzip("packed", content), std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(in), {});
    }

    /// 4 x 3 x 2 voxels of 1 x 2 x 3 mm, the first one's centre at (10, 20, 30) mm.
    void expect_image(const std::string &file) const
    {
      const LabelImage image = read_image(file, 0.001);
      ASSERT_EQ(image.size, (std::array<unsigned int, 3>{{n_x, n_y, n_z}})) << file;
      EXPECT_LT(image.origin.distance(Point(0.01, 0.02, 0.03)), 1e-9)
        << file << ' ' << image.origin;
      EXPECT_LT((image.spacing - Direction({0.001, 0.002, 0.003})).norm(), 1e-9)
        << file << ' ' << image.spacing;
      std::size_t v = 0;
      for (unsigned int k = 0; k < n_z; ++k)
        for (unsigned int j = 0; j < n_y; ++j)
          for (unsigned int i = 0; i < n_x; ++i)
            ASSERT_EQ(image.values[image.voxels[v++]], label(i, j, k)) << file;
    }

    void expect_refused(const std::string &file, const std::string &hint) const
    {
      try
      {
        read_image(file, 1);
        ADD_FAILURE() << file << " was accepted";
      }
      catch (const BadInput &e)
      {
        EXPECT_NE(std::string(e.what()).find(hint), std::string::npos) << e.what();
      }
    }

    const std::filesystem::path folder_;
  };
} // namespace

TEST_F(Image, InrimageOfEachInteger)
{
  expect_image(write("a.inr", inr_header() + voxels()));
  expect_image(write_gzip("a.inr.gz", inr_header() + voxels()));
  expect_image(write("b.inr", inr_header("TYPE=unsigned fixed\nPIXSIZE=16 bits\n") + voxels(2)));
  expect_image(write("c.inr", inr_header("TYPE=signed fixed\nPIXSIZE=32 bits\n") + voxels(4)));
}

TEST_F(Image, MetaImageRawCompressedAndDetached)
{
  expect_image(write("a.mha", meta_header("MET_UCHAR", "") + voxels()));
  expect_image(
    write("b.mha", meta_header("MET_SHORT", "BinaryDataByteOrderMSB = True\n") + voxels(2, true)));
  expect_image(
    write("c.mha", meta_header("MET_UINT", "CompressedData = True\n") + zlib(voxels(4))));
  write("d.raw", voxels());
  expect_image(write("d.mhd", meta_header("MET_UCHAR", "", "d.raw")));
}

TEST_F(Image, NrrdRawGzipAndDetached)
{
  expect_image(write("a.nrrd", nrrd_header("unsigned char", "raw", nrrd_place) + voxels()));
  expect_image(write("b.nrrd", nrrd_header("uint8", "gzip", nrrd_place) + gzipped(voxels())));
  expect_image(
    write("c.nrrd", nrrd_header("int64", "raw", "endian: big\n" + nrrd_place) + voxels(8, true)));
  expect_image(write(
    "d.nrrd",
    nrrd_header("uint16", "raw",
                "space: right-anterior-superior\nspace directions: (-1,0,0) (0,-2,0) (0,0,3)\n"
                "space origin: (-10,-20,30)\n") +
      voxels(2)));
  write("e.raw", voxels());
  expect_image(write("e.nhdr", nrrd_header("uchar", "raw", nrrd_place + "data file: e.raw\n")));
}

TEST_F(Image, NiftiBySformAndQform)
{
  expect_image(write("a.nii", nifti_header(true) + voxels()));
  expect_image(write_gzip("b.nii.gz", nifti_header(false, 512) + voxels(2)));
}

/// The file's first index runs down z, its second along y, its third along x.
TEST_F(Image, AxesMayBeExchangedAndFlipped)
{
  std::string data;
  for (unsigned int i = 0; i < n_x; ++i)
    for (unsigned int j = 0; j < n_y; ++j)
      for (unsigned int k = n_z; k-- > 0;)
        data += static_cast<char>(label(i, j, k));
  expect_image(write(
    "turned.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\nspace: LPS\n"
                   "space directions: (0,0,-3) (0,2,0) (1,0,0)\nspace origin: (10,20,33)\n\n" +
                     data));
}

TEST_F(Image, NegativeLabelsKeepTheirSign)
{
  const LabelImage image = read_image(
    write("a.nrrd", "NRRD0004\ntype: int16\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n\n" +
                      std::string("\xff\xff\x05\0", 4)),
    1);
  EXPECT_EQ(image.values, std::vector<std::int64_t>({-1, 5}));
}

TEST_F(Image, RefusesBrokenFiles)
{
  const std::string inr = inr_header() + voxels(), packed = gzipped(inr);
  expect_refused(folder_ / "missing.inr", "there is no such file");
  expect_refused(write("a.jpg", inr), "ending '.jpg'");
  expect_refused(write("empty.nrrd", ""), "no NRRD");
  expect_refused(write("a.mhd", inr), "no MetaImage");
  expect_refused(write("a.nii", inr), "no single-file NIfTI-1");
  expect_refused(write("wrong.inr", nifti_header(true) + voxels()), "no INRIMAGE-4");
  expect_refused(write("short.inr", inr.substr(0, inr.size() - 1)), "cut short");
  expect_refused(write("long.inr", inr + voxels()), "mend the size");
  expect_refused(write("short.inr.gz", packed.substr(0, packed.size() / 2)),
                 "damaged or cut short");
  expect_refused(write("garbage.inr.gz", "\x1f\x8b" + inr), "damaged");
  expect_refused(write("garbage.nrrd", nrrd_header("uchar", "gzip", nrrd_place) + voxels()),
                 "damaged");
  expect_refused(write("no.mhd", meta_header("MET_UCHAR", "", "nowhere.raw")),
                 "there is no such file as " + (folder_ / "nowhere.raw").string());
}

TEST_F(Image, RefusesWhatIsNoSegmentationInSpace)
{
  const std::string type = "TYPE=unsigned fixed\nPIXSIZE=8 bits\n";
  expect_refused(write("a.inr", inr_header(type, "VX=1\nVY=0\nVZ=3\n") + voxels()), "not above 0");
  expect_refused(write("b.inr", inr_header(type, "VX=nan\nVY=2\nVZ=3\n") + voxels()),
                 "not above 0");
  expect_refused(write("c.inr", inr_header(type, "VX=-1\nVY=2\nVZ=3\n") + voxels()), "not above 0");
  expect_refused(write("d.inr", inr_header(type, "VX=wide\nVY=2\nVZ=3\n") + voxels()),
                 "is no number");
  expect_refused(write("e.inr", inr_header("TYPE=float\nPIXSIZE=32 bits\n") + voxels(4)),
                 "labels are integers");
  expect_refused(write("f.mha", meta_header("MET_FLOAT", "") + voxels(4)), "labels are integers");
  expect_refused(
    write("g.mha",
          meta_header("MET_UCHAR", "TransformMatrix = 0.8 0.6 0 -0.6 0.8 0 0 0 1\n") + voxels()),
    "oblique");
  expect_refused(
    write("h.nrrd",
          nrrd_header("uchar", "raw", "space: LPS\nspace directions: (1,0,0) (0,2,0) (0,0,0)\n") +
            voxels()),
    "places its voxels nowhere");
  expect_refused(
    write("i.nrrd", "NRRD0004\ntype: uchar\nsizes: 4 3 2 1\nencoding: raw\n\n" + voxels()),
    "3 number");
  expect_refused(
    write("j.nrrd", "NRRD0004\ntype: uchar\nsizes: 4 3 0\nencoding: raw\n\n" + voxels()),
    "mend the header");

  std::string picture;
  for (unsigned int v = 0; v < 300; ++v)
    picture += {static_cast<char>(v % 256), static_cast<char>(v / 256)};
  expect_refused(
    write("k.nrrd", "NRRD0004\ntype: uint16\nsizes: 300 1 1\nencoding: raw\n\n" + picture),
    "no segmentation");
}
