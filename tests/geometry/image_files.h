// SPDX-License-Identifier: LGPL-2.1-or-later
// Small segmentations as the bytes of image files: 4 x 3 x 2 voxels of 1 x 2 x 3 mm, the first
// one's centre at (10, 20, 30) mm.
#pragma once

#include <cstring>
#include <string>

#include <zlib.h>

namespace softcell
{
  constexpr unsigned int n_x = 4, n_y = 3, n_z = 2;

  /// 0, 1 or 200 in a pattern without symmetry.
  inline int label(const unsigned int i, const unsigned int j, const unsigned int k)
  {
    return i == 0 ? 0 : (i + 2 * j + 3 * k) % 5 < 2 ? 1 : 200;
  }

  /// The voxels' bytes, x fastest, each of `bytes`.
  inline std::string voxels(const unsigned int bytes = 1, const bool big_endian = false)
  {
    std::string data;
    for (unsigned int k = 0; k < n_z; ++k)
      for (unsigned int j = 0; j < n_y; ++j)
        for (unsigned int i = 0; i < n_x; ++i)
        {
          std::string value(bytes, '\0');
          value[big_endian ? bytes - 1 : 0] = label(i, j, k);
          data += value;
        }
    return data;
  }

  inline std::string zlib(const std::string &data)
  {
    std::string packed(compressBound(data.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef *>(packed.data()), &size,
             reinterpret_cast<const Bytef *>(data.data()), data.size());
    return packed.substr(0, size);
  }

  inline std::string inr_header(const std::string &type = "TYPE=unsigned fixed\nPIXSIZE=8 bits\n",
                                const std::string &spacing = "VX=1\nVY=2\nVZ=3\n")
  {
    std::string header = "#INRIMAGE-4#{\nXDIM=4\nYDIM=3\nZDIM=2\nVDIM=1\n" + type +
                         "SCALE=2**0\nCPU=decm\n" + spacing + "TX=10\nTY=20\nTZ=30\n";
    header.resize(252, '\n');
    return header + "##}\n";
  }

  inline std::string meta_header(const std::string &type,
                                 const std::string &extra,
                                 const std::string &data_file = "LOCAL")
  {
    return "ObjectType = Image\nNDims = 3\n" + extra +
           "Offset = 10 20 30\nElementSpacing = 1 2 3\n" +
           "DimSize = 4 3 2\nElementType = " + type + "\nElementDataFile = " + data_file + "\n";
  }

  inline std::string
  nrrd_header(const std::string &type, const std::string &encoding, const std::string &place)
  {
    return "NRRD0004\n# a comment: with a colon\ntype: " + type +
           "\ndimension: 3\nsizes: 4 3 2\nkind of key:=value\nencoding: " + encoding + "\n" +
           place + "\n";
  }

  inline const std::string nrrd_place =
    "space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0) (0,0,3)\n"
    "space origin: (10,20,30)\n";

  /// The 352 bytes before the data, placed by the sform or the qform.
  inline std::string nifti_header(const bool by_sform, const short type = 2)
  {
    std::string header(352, '\0');
    const auto put = [&](const std::size_t at, const auto value) {
      std::memcpy(&header[at], &value, sizeof(value));
    };
    put(0, 348);
    const short size[] = {3, n_x, n_y, n_z, 1, 1, 1, 1};
    std::memcpy(&header[40], size, sizeof(size));
    put(70, type);
    const float spacing[] = {1, 1, 2, 3};
    std::memcpy(&header[76], spacing, sizeof(spacing));
    put(108, 352.f);
    if (by_sform)
    {
      put(254, short(1));
      const float rows[] = {-1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30};
      std::memcpy(&header[280], rows, sizeof(rows));
    }
    else // half a turn about z
    {
      put(252, short(1));
      const float quaternion[] = {0, 0, 1, -10, -20, 30};
      std::memcpy(&header[256], quaternion, sizeof(quaternion));
    }
    std::memcpy(&header[344], "n+1", 3);
    return header;
  }
} // namespace softcell
