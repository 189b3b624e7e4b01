// SPDX-License-Identifier: LGPL-2.1-or-later
// What the header of an image says, whatever its format.
#pragma once

#include <softcell/base/types.h>

#include <array>
#include <cstdint>
#include <string>

namespace softcell
{
  /// What the formats' headers have in common. Lengths in the file's unit.
  struct ImageHeader
  {
    std::array<double, 3> size;
    Point origin;
    std::array<Direction, 3> steps; // from a voxel to the next one of each index, the first fastest
    unsigned int bytes = 1;         // of a voxel
    bool is_signed     = false;
    bool big_endian    = false;
    bool compressed    = false;
    std::string data_file; // empty: the header's own
    std::size_t data_start = 0;
  };

  /// Reads the header of INRIMAGE, MetaImage, NRRD or NIfTI, told by the file's ending.
  /// @param content of the file, uncompressed if all of it was compressed.
  /// @throws BadInput
  ImageHeader read_image_header(const std::string &file, const std::string &content);

  /// @throws BadInput
  [[noreturn]] void refuse_image(const std::string &file, const std::string &reason);

  /// A number of n bytes.
  inline std::uint64_t
  unsigned_number(const char *bytes, const unsigned int n, const bool big_endian)
  {
    std::uint64_t value = 0;
    for (unsigned int i = 0; i < n; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[big_endian ? i : n - 1 - i]);
    return value;
  }

  inline std::int64_t signed_number(const char *bytes, const unsigned int n, const bool big_endian)
  {
    const unsigned int shift = 64 - 8 * n;
    return static_cast<std::int64_t>(unsigned_number(bytes, n, big_endian) << shift) >> shift;
  }
} // namespace softcell
