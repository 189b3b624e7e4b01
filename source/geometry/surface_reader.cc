// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads surface files. What a file must hold is counted, so that a truncated one is never taken for
// a smaller one.

#include <softcell/geometry/surface_soup.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>

namespace softcell
{
  namespace
  {
    const char truncated[] = "the file ends too early, so it is truncated; copy or export it again";

    /// The content of a file as words and numbers, which knows the line for messages.
    class Text
    {
    public:
      Text(const std::string &file, const std::string &content) : file_(file), content_(content) {}

      [[noreturn]] void fail(const std::string &what) const
      {
        const auto line = 1 + std::count(content_.begin(), content_.begin() + position_, '\n');
        throw BadInput(file_ + ": line " + std::to_string(line) + ": " + what);
      }

      /// The next word, without comments; empty at the end.
      std::string_view word()
      {
        skip_space();
        while (position_ < content_.size() && content_[position_] == '#')
        {
          rest_of_line();
          skip_space();
        }
        const std::size_t begin = position_;
        position_ = std::min(content_.find_first_of(" \t\r\n", begin), content_.size());
        return content_.substr(begin, position_ - begin);
      }

      std::string_view rest_of_line()
      {
        const std::size_t begin = position_;
        const std::size_t end   = std::min(content_.find('\n', begin), content_.size());
        position_               = std::min(end + 1, content_.size());
        return content_.substr(begin, end - begin);
      }

      void expect(const std::string_view expected)
      {
        const std::string_view found = word();
        if (found.empty())
          fail(truncated);
        if (found != expected)
          fail("expected '" + std::string(expected) + "' but found '" + std::string(found) +
               "'; export the file again");
      }

      double number()
      {
        std::string_view found = word();
        if (found.empty())
          fail(truncated);
        if (found.front() == '+')
          found.remove_prefix(1);
        double value            = 0;
        const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
        if (error == std::errc::result_out_of_range)
          value = std::strtod(std::string(found).c_str(), nullptr); // infinity or zero
        if (error == std::errc::invalid_argument || end != found.data() + found.size())
          fail("expected a number but found '" + std::string(found) + "'; export the file again");
        return value;
      }

      Point point()
      {
        const double x = number(), y = number(), z = number();
        return Point(x, y, z);
      }

      /// A number of something, or the number of a point.
      unsigned int count()
      {
        return as_count(number());
      }
      unsigned int as_count(const double value) const
      {
        if (!(value >= 0 && value < 4e9 && value == std::floor(value)))
          fail("expected a count or the number of a point but found " + std::to_string(value) +
               "; export the file again");
        return static_cast<unsigned int>(value);
      }

      /// Bytes of a binary file.
      std::string_view bytes(const std::size_t n)
      {
        if (content_.size() - position_ < n)
          throw BadInput(file_ + ": " + truncated + ".");
        position_ += n;
        return content_.substr(position_ - n, n);
      }

    private:
      void skip_space()
      {
        position_ = std::min(content_.find_first_not_of(" \t\r\n", position_), content_.size());
      }

      const std::string &file_;
      std::string_view content_;
      std::size_t position_ = 0;
    };

    SurfaceSoup read_off(Text text)
    {
      SurfaceSoup soup;
      text.expect("OFF");
      const unsigned int n_points = text.count(), n_polygons = text.count();
      text.count(); // of edges, which nobody needs
      for (unsigned int i = 0; i < n_points; ++i)
      {
        soup.points.push_back(text.point());
        text.rest_of_line(); // colours, normals
      }
      for (unsigned int i = 0; i < n_polygons; ++i)
      {
        auto &polygon = soup.polygons.emplace_back();
        for (unsigned int n = text.count(); n > 0; --n)
          polygon.push_back(text.count());
        text.rest_of_line();
      }
      return soup;
    }

    /// Groups and objects are patches, numbered as their names first appear with a face.
    SurfaceSoup read_obj(Text text)
    {
      SurfaceSoup soup;
      std::map<std::string, unsigned int> groups;
      std::string group;
      for (std::string_view key = text.word(); !key.empty(); key = text.word())
        if (key == "v")
        {
          soup.points.push_back(text.point());
          text.rest_of_line();
        }
        else if (key == "f")
        {
          const std::string line(text.rest_of_line());
          Text corners(line, line);
          auto &polygon = soup.polygons.emplace_back();
          for (std::string_view corner = corners.word(); !corner.empty(); corner = corners.word())
          {
            long index = 0; // from 1, or from -1 backwards
            const auto [end, error] =
              std::from_chars(corner.data(), corner.data() + corner.size(), index);
            const bool read =
              error == std::errc() && (end == corner.data() + corner.size() || *end == '/');
            if (!read || index == 0)
              text.fail("expected the number of a point but found '" + std::string(corner) +
                        "'; export the file again");
            polygon.push_back(
              text.as_count(index > 0 ? index - 1. : soup.points.size() + double(index)));
          }
          soup.patches.push_back(groups.emplace(group, groups.size()).first->second);
        }
        else if (key == "g" || key == "o")
          group = text.rest_of_line();
        else
          text.rest_of_line(); // normals, texture, material
      return soup;
    }

    /// Each `solid` is a patch.
    SurfaceSoup read_stl_text(Text text)
    {
      SurfaceSoup soup;
      unsigned int patch = 0;
      for (std::string_view key = text.word(); !key.empty(); key = text.word(), ++patch)
      {
        if (key != "solid")
          text.fail("expected 'solid' but found '" + std::string(key) + "'; export the file again");
        text.rest_of_line();
        for (key = text.word(); key == "facet"; key = text.word())
        {
          text.expect("normal");
          text.point();
          text.expect("outer");
          text.expect("loop");
          auto &polygon = soup.polygons.emplace_back();
          for (unsigned int i = 0; i < 3; ++i)
          {
            text.expect("vertex");
            polygon.push_back(soup.points.size());
            soup.points.push_back(text.point());
          }
          text.expect("endloop");
          text.expect("endfacet");
          soup.patches.push_back(patch);
        }
        if (key != "endsolid")
          text.fail(key.empty() ? truncated
                                : "expected 'facet' or 'endsolid'; export the file again");
        text.rest_of_line();
      }
      return soup;
    }

    template <class T>
    T from_bytes(const std::string_view bytes, const bool reversed = false)
    {
      char copy[sizeof(T)];
      std::copy_n(bytes.data(), sizeof(T), copy);
      if (reversed)
        std::reverse(copy, copy + sizeof(T));
      T value;
      std::memcpy(&value, copy, sizeof(T));
      return value;
    }

    /// Binary: 80 bytes of header, the number of triangles, 50 bytes for each. Many begin with
    /// "solid" all the same.
    SurfaceSoup read_stl(const std::string &file, std::string content)
    {
      const std::size_t header = 84, triangle_size = 50;
      Text text(file, content);
      SurfaceSoup soup;
      soup.is_unconnected = true;

      const bool has_zero = std::find(content.begin(), content.end(), '\0') != content.end();
      if (!has_zero && text.word() == "solid")
      {
        std::transform(content.begin(), content.end(), content.begin(), ::tolower);
        soup                = read_stl_text(Text(file, content));
        soup.is_unconnected = true;
        return soup;
      }
      if (content.size() < header)
        throw BadInput(
          file + ": neither a text STL, which begins with 'solid', nor a binary one, which has " +
          "more than 84 bytes; export it again.");
      const auto n_triangles = from_bytes<std::uint32_t>(std::string_view(content).substr(80));
      if (content.size() < header + triangle_size * n_triangles)
        throw BadInput(file + ": the header announces " + std::to_string(n_triangles) +
                       " triangles but the file has " + "room for " +
                       std::to_string((content.size() - header) / triangle_size) +
                       ", so it is truncated or no STL; copy or export it again.");
      for (unsigned int t = 0; t < n_triangles; ++t)
      {
        auto &polygon = soup.polygons.emplace_back();
        for (unsigned int corner = 0; corner < 3; ++corner)
        {
          polygon.push_back(soup.points.size());
          Point &X = soup.points.emplace_back();
          for (unsigned int d = 0; d < 3; ++d)
            X[d] = from_bytes<float>(std::string_view(content).substr(header + triangle_size * t +
                                                                      12 + 12 * corner + 4 * d));
        }
      }
      return soup;
    }

    /// Reads the header of a PLY and then its elements, of which only points and faces are kept.
    class PlyReader
    {
    public:
      explicit PlyReader(Text text) : text_(text) {}

      SurfaceSoup read()
      {
        read_header();
        SurfaceSoup soup;
        for (const Element &element : elements_)
          for (unsigned int i = 0; i < element.n; ++i)
          {
            if (element.name == "vertex")
              soup.points.emplace_back();
            else if (element.name == "face")
              soup.polygons.emplace_back();
            for (const Property &property : element.properties)
            {
              const unsigned int n =
                property.count_type.empty() ? 1 : text_.as_count(value(property.count_type));
              for (unsigned int k = 0; k < n; ++k)
              {
                const double x = value(property.type);
                if (element.name == "vertex" && property.name.size() == 1 &&
                    property.name[0] >= 'x' && property.name[0] <= 'z')
                  soup.points.back()[property.name[0] - 'x'] = x;
                else if (element.name == "face" &&
                         (property.name == "vertex_indices" || property.name == "vertex_index"))
                  soup.polygons.back().push_back(text_.as_count(x));
              }
            }
          }
        return soup;
      }

    private:
      struct Property
      {
        std::string name, type, count_type; // of lists
      };
      struct Element
      {
        std::string name;
        unsigned int n;
        std::vector<Property> properties;
      };

      void read_header()
      {
        text_.expect("ply");
        text_.expect("format");
        format_ = text_.word();
        if (format_ != "ascii" && format_ != "binary_little_endian" &&
            format_ != "binary_big_endian")
          text_.fail("unknown format '" + format_ +
                     "'; export the file as ascii or binary_little_endian");
        text_.rest_of_line();
        for (std::string key(text_.word()); key != "end_header"; key = text_.word())
          if (key == "element")
          {
            const std::string name(text_.word());
            elements_.push_back({name, text_.count(), {}});
          }
          else if (key == "property" && !elements_.empty())
          {
            Property property;
            property.type = text_.word();
            if (property.type == "list")
            {
              property.count_type = text_.word();
              property.type       = text_.word();
            }
            property.name = text_.word();
            elements_.back().properties.push_back(property);
          }
          else if (key == "comment" || key == "obj_info")
            text_.rest_of_line();
          else
            text_.fail(key.empty() ? truncated
                                   : "unknown header entry '" + key + "'; export the file again");
        text_.rest_of_line();
      }

      double value(const std::string &type)
      {
        if (format_ == "ascii")
          return text_.number();
        const bool swap = format_ == "binary_big_endian";
        if (type == "char" || type == "int8")
          return from_bytes<std::int8_t>(text_.bytes(1));
        if (type == "uchar" || type == "uint8")
          return from_bytes<std::uint8_t>(text_.bytes(1));
        if (type == "short" || type == "int16")
          return from_bytes<std::int16_t>(text_.bytes(2), swap);
        if (type == "ushort" || type == "uint16")
          return from_bytes<std::uint16_t>(text_.bytes(2), swap);
        if (type == "int" || type == "int32")
          return from_bytes<std::int32_t>(text_.bytes(4), swap);
        if (type == "uint" || type == "uint32")
          return from_bytes<std::uint32_t>(text_.bytes(4), swap);
        if (type == "float" || type == "float32")
          return from_bytes<float>(text_.bytes(4), swap);
        if (type == "double" || type == "float64")
          return from_bytes<double>(text_.bytes(8), swap);
        text_.fail("unknown type '" + type + "' in the header; export the file again");
      }

      Text text_;
      std::string format_;
      std::vector<Element> elements_;
    };

    SurfaceSoup read_soup(const std::string &file)
    {
      std::string ending = std::filesystem::path(file).extension();
      std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);

      check_file("Geometry/File = " + file, file);
      std::ifstream stream(file, std::ios::binary);
      std::string content((std::istreambuf_iterator<char>(stream)),
                          std::istreambuf_iterator<char>());
      if (content.empty())
        throw BadInput(file + ": the file is empty; copy or export it again.");

      if (ending == ".off")
        return read_off(Text(file, content));
      if (ending == ".obj")
        return read_obj(Text(file, content));
      if (ending == ".stl")
        return read_stl(file, std::move(content));
      if (ending == ".ply")
        return PlyReader(Text(file, content)).read();
      if (ending == ".vtp" || ending == ".vtk")
        return read_vtk_soup(file);
      throw BadInput(file + ": unknown ending '" + ending +
                     "' of a surface file; give an OFF, OBJ, STL, PLY or VTP file.");
    }
  } // namespace

  Surface
  read_surface(const std::string &file, const double scale, std::vector<std::string> &repairs)
  {
    Assert(scale > 0, dealii::ExcMessage("The scale must be positive."));
    const Surface surface       = close_surface(read_soup(file), file, repairs);
    std::vector<Point> vertices = surface.vertices();
    for (Point &vertex : vertices)
      vertex *= scale;
    return Surface(std::move(vertices), surface.triangles(), surface.patches());
  }
} // namespace softcell
