// SPDX-License-Identifier: LGPL-2.1-or-later
// Surface files for tests, written into a temporary folder that goes with the test.
#pragma once

#include <softcell/geometry/surface.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

namespace softcell::testing
{
  class TemporaryFolder
  {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("softcell-surface-" + std::to_string(getpid())))
    {
      std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder()
    {
      std::filesystem::remove_all(path_);
    }
    std::string path(const std::string &name) const
    {
      return path_ / name;
    }
    std::string write(const std::string &name, const std::string &content) const
    {
      std::ofstream(path(name), std::ios::binary) << content;
      return path(name);
    }

  private:
    std::filesystem::path path_;
  };

  inline std::string as_off(const Surface &surface)
  {
    std::ostringstream out;
    out.precision(17);
    out << "OFF # a comment\n"
        << surface.vertices().size() << ' ' << surface.triangles().size() << " 0\n";
    for (const Point &X : surface.vertices())
      out << X << '\n';
    for (const auto &[a, b, c] : surface.triangles())
      out << "3 " << a << ' ' << b << ' ' << c << " 255 0 0\n";
    return out.str();
  }

  /// Patches are groups; half of the faces count points backwards and name normals.
  inline std::string as_obj(const Surface &surface)
  {
    std::ostringstream out;
    out.precision(17);
    out << "# a comment\nmtllib none.mtl\n";
    for (const Point &X : surface.vertices())
      out << "v " << X << "\nvn 0 0 1\n";
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto &[a, b, c] = surface.triangles()[t];
      const int n           = surface.vertices().size();
      out << "g part" << surface.patches()[t] << '\n';
      if (t % 2)
        out << "f " << int(a) - n << "//1 " << int(b) - n << "//1 " << int(c) - n << "//1\n";
      else
        out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
    }
    return out.str();
  }

  /// Patches are solids; the triangles must be sorted by them.
  inline std::string as_stl_text(const Surface &surface)
  {
    std::ostringstream out;
    out.precision(17);
    const unsigned int n = surface.triangles().size();
    for (unsigned int t = 0; t < n; ++t)
    {
      if (t == 0 || surface.patches()[t] != surface.patches()[t - 1])
        out << "solid some name\n";
      out << " facet normal 0 0 0\n  outer loop\n";
      for (const Point &X : surface.corners(t))
        out << "   vertex " << std::scientific << X << '\n';
      out << "  endloop\n endfacet\n";
      if (t + 1 == n || surface.patches()[t] != surface.patches()[t + 1])
        out << "endsolid some name\n";
    }
    return out.str();
  }

  template <class T>
  void append_bytes(std::string &out, const T value, const bool reversed = false)
  {
    std::string bytes(reinterpret_cast<const char *>(&value), sizeof(T));
    out += reversed ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
  }

  inline std::string as_stl_binary(const Surface &surface)
  {
    std::string out = "solid by name only";
    out.resize(80, ' ');
    append_bytes<std::uint32_t>(out, surface.triangles().size());
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      for (unsigned int d = 0; d < 3; ++d)
        append_bytes<float>(out, surface.normal(t)[d]);
      for (const Point &X : surface.corners(t))
        for (unsigned int d = 0; d < 3; ++d)
          append_bytes<float>(out, X[d]);
      append_bytes<std::uint16_t>(out, 0);
    }
    return out;
  }

  /// @param format ascii, binary_little_endian or binary_big_endian
  inline std::string as_ply(const Surface &surface, const std::string &format)
  {
    std::ostringstream header;
    header << "ply\nformat " << format << " 1.0\ncomment none\nelement vertex "
           << surface.vertices().size()
           << "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar "
              "red\nelement face "
           << surface.triangles().size()
           << "\nproperty list uchar int vertex_indices\nend_header\n";
    std::string out = header.str();
    std::ostringstream text;
    text.precision(17);
    const bool reversed = format == "binary_big_endian";
    for (const Point &X : surface.vertices())
    {
      text << X << " 7\n";
      for (unsigned int d = 0; d < 3; ++d)
        append_bytes<double>(out, X[d], reversed);
      append_bytes<std::uint8_t>(out, 7);
    }
    for (const auto &triangle : surface.triangles())
    {
      text << "3 " << triangle[0] << ' ' << triangle[1] << ' ' << triangle[2] << '\n';
      append_bytes<std::uint8_t>(out, 3);
      for (const unsigned int v : triangle)
        append_bytes<std::int32_t>(out, v, reversed);
    }
    return format == "ascii" ? header.str() + text.str() : out;
  }
} // namespace softcell::testing
