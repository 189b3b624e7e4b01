// SPDX-License-Identifier: LGPL-2.1-or-later
// What the header of an image says, whatever its format.

#include "image_header.h"

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

namespace softcell
{
  void refuse_image(const std::string &file, const std::string &reason)
  {
    throw BadInput(file + ": " + reason);
  }

  namespace
  {
    std::string trimmed(const std::string &text)
    {
      const std::size_t begin = text.find_first_not_of(" \t\r");
      return begin == std::string::npos
               ? ""
               : text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
    }

    std::string lower_case(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(),
                     [](unsigned char c) { return std::tolower(c); });
      return text;
    }

    bool holds(const std::string &text, const std::string &part)
    {
      return text.find(part) != std::string::npos;
    }

    /// The lines `NAME separator VALUE` of a header.
    class Entries
    {
    public:
      Entries(const std::string &file, const std::string &text, const char separator) : file_(file)
      {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
          if (const std::size_t at = line.find(separator);
              at != std::string::npos && line[0] != '#')
            entries_[trimmed(line.substr(0, at))] = trimmed(line.substr(at + 1));
      }

      /// The first of the names that is there; empty if none is.
      std::string text(const std::initializer_list<const char *> &names) const
      {
        for (const char *name : names)
          if (const auto entry = entries_.find(name); entry != entries_.end())
            return entry->second;
        return "";
      }

      std::string needed_text(const std::initializer_list<const char *> &names) const
      {
        std::string value = text(names);
        if (value.empty())
          refuse_image(file_, "the header has no entry '" + std::string(*names.begin()) + "'.");
        return value;
      }

      /// `count` numbers, which may stand in brackets; `otherwise` if there is no such entry.
      std::vector<double> numbers(const std::initializer_list<const char *> &names,
                                  const std::size_t count,
                                  const std::vector<double> &otherwise = {}) const
      {
        std::string value = otherwise.empty() ? needed_text(names) : text(names);
        if (value.empty())
          return otherwise;
        std::replace_if(
          value.begin(), value.end(), [](char c) { return std::strchr("(),", c); }, ' ');
        std::istringstream words(value);
        std::vector<double> result;
        for (std::string word; words >> word;)
        {
          char *end = nullptr;
          result.push_back(std::strtod(word.c_str(), &end));
          if (*end != '\0')
            refuse_image(file_,
                         "'" + word + "' of the entry '" + *names.begin() + "' is no number.");
        }
        if (result.size() != count)
          refuse_image(
            file_,
            "'" + std::string(*names.begin()) + " = " + value + "' should be " +
              std::to_string(count) +
              " number(s); only three-dimensional images with one value per voxel can be read.");
        return result;
      }

    private:
      std::string file_;
      std::map<std::string, std::string> entries_;
    };

    Direction vector(const std::vector<double> &values, const unsigned int first = 0)
    {
      return Direction({values[first], values[first + 1], values[first + 2]});
    }

    std::array<Direction, 3> axis_steps(const std::string &file, const std::vector<double> &spacing)
    {
      std::array<Direction, 3> steps;
      for (unsigned int d = 0; d < dim; ++d)
      {
        if (!(spacing[d] > 0 && std::isfinite(spacing[d])))
          refuse_image(file, "the voxel size " + std::to_string(spacing[d]) +
                               " is not above 0; mend the header.");
        steps[d][d] = spacing[d];
      }
      return steps;
    }

    /// Changes to a frame with coordinate d the other way round.
    void turn_round(ImageHeader &header, const unsigned int d)
    {
      header.origin[d] *= -1;
      for (Direction &step : header.steps)
        step[d] *= -1;
    }

    /// Understands the names of C, NRRD and MetaImage for integers.
    void set_voxel_type(ImageHeader &header, const std::string &file, const std::string &name)
    {
      const std::string type = lower_case(name);
      for (const char *other : {"float", "double", "block", "array", "ascii"})
        if (holds(type, other))
          refuse_image(file, "its voxels are of type " + name +
                               ", labels are integers; convert the file.");
      header.is_signed = type[0] != 'u';
      header.bytes     = holds(type, "char") || holds(type, "int8")      ? 1
                         : holds(type, "short") || holds(type, "16")     ? 2
                         : holds(type, "64") || holds(type, "long long") ? 8
                         : holds(type, "int") || holds(type, "long")     ? 4
                                                                         : 0;
      if (header.bytes == 0)
        refuse_image(file, "its voxels are of the unknown type " + name + ".");
    }

    ImageHeader inrimage_header(const std::string &file, const std::string &content)
    {
      const std::size_t end = content.find("##}");
      if (content.compare(0, 12, "#INRIMAGE-4#") != 0 || end == std::string::npos)
        refuse_image(file,
                     "it is no INRIMAGE-4 file: '#INRIMAGE-4#{' and the '##}' that ends the header "
                     "are missing.");
      const Entries entries(file, content.substr(content.find('\n') + 1, end), '=');

      ImageHeader header;
      if (entries.numbers({"VDIM"}, 1, {1.})[0] != 1)
        refuse_image(file, "it has several values per voxel (VDIM); labels are single numbers.");
      for (const char *axis : {"X", "Y", "Z"})
        header.size[*axis - 'X'] = entries.numbers({(axis + std::string("DIM")).c_str()}, 1)[0];
      header.steps =
        axis_steps(file, {entries.numbers({"VX"}, 1, {1.})[0], entries.numbers({"VY"}, 1, {1.})[0],
                          entries.numbers({"VZ"}, 1, {1.})[0]});
      header.origin =
        Point(entries.numbers({"TX"}, 1, {0.})[0], entries.numbers({"TY"}, 1, {0.})[0],
              entries.numbers({"TZ"}, 1, {0.})[0]);
      const std::string type = entries.needed_text({"TYPE"}),
                        bits = entries.needed_text({"PIXSIZE"});
      set_voxel_type(header, file,
                     holds(type, "fixed") ? (holds(type, "unsigned") ? "uint" : "int") +
                                              std::to_string(std::atoi(bits.c_str()))
                                          : type);
      const std::string processor = entries.text({"CPU"});
      header.big_endian           = processor == "sun" || processor == "sgi";
      header.data_start           = (end + 3 + 255) / 256 * 256; // headers come in blocks of 256
      return header;
    }

    ImageHeader meta_header(const std::string &file, const std::string &content)
    {
      const std::size_t last = content.find("ElementDataFile");
      if (last == std::string::npos)
        refuse_image(file, "it is no MetaImage: the header has no entry 'ElementDataFile'.");
      const std::size_t end = std::min(content.find('\n', last), content.size());
      const Entries entries(file, content.substr(0, end), '=');

      ImageHeader header;
      const std::vector<double> size = entries.numbers({"DimSize"}, 3);
      std::copy(size.begin(), size.end(), header.size.begin());
      header.steps =
        axis_steps(file, entries.numbers({"ElementSpacing", "ElementSize"}, 3, {1, 1, 1}));
      const std::vector<double> directions = entries.numbers(
        {"TransformMatrix", "Orientation", "Rotation"}, 9, {1, 0, 0, 0, 1, 0, 0, 0, 1});
      for (unsigned int d = 0; d < dim; ++d)
        header.steps[d] = vector(directions, 3 * d) * header.steps[d][d];
      header.origin =
        Point(vector(entries.numbers({"Offset", "Position", "Origin"}, 3, {0, 0, 0})));
      set_voxel_type(header, file, entries.needed_text({"ElementType"}).substr(4));
      if (entries.numbers({"ElementNumberOfChannels"}, 1, {1.})[0] != 1)
        refuse_image(
          file,
          "it has several values per voxel (ElementNumberOfChannels); labels are single numbers.");
      if (lower_case(entries.text({"BinaryData"})) == "false")
        refuse_image(file, "its data are text (BinaryData = False); write it as binary data.");
      header.big_endian =
        lower_case(entries.text({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"})) == "true";
      header.compressed       = lower_case(entries.text({"CompressedData"})) == "true";
      const std::string where = entries.needed_text({"ElementDataFile"});
      header.data_file        = lower_case(where) == "local" ? "" : where;
      header.data_start       = header.data_file.empty() ? end + 1 : 0;
      return header;
    }

    ImageHeader nrrd_header(const std::string &file, const std::string &content)
    {
      if (content.compare(0, 4, "NRRD") != 0)
        refuse_image(file, "it is no NRRD file: it does not begin with 'NRRD'.");
      std::size_t end = std::min(content.find("\n\n"), content.find("\n\r\n"));
      end             = std::min(end, content.size());
      const Entries entries(file, content.substr(0, end), ':');

      ImageHeader header;
      const std::vector<double> size = entries.numbers({"sizes"}, 3);
      std::copy(size.begin(), size.end(), header.size.begin());
      if (entries.text({"space directions"}).empty())
        header.steps = axis_steps(file, entries.numbers({"spacings"}, 3, {1, 1, 1}));
      else
      {
        const std::vector<double> directions = entries.numbers({"space directions"}, 9);
        for (unsigned int d = 0; d < dim; ++d)
          header.steps[d] = vector(directions, 3 * d);
      }
      header.origin           = Point(vector(entries.numbers({"space origin"}, 3, {0, 0, 0})));
      const std::string space = lower_case(entries.text({"space"}));
      const bool is_ras       = space == "ras" || space == "right-anterior-superior";
      if (is_ras)
        turn_round(header, 0);
      if (is_ras || space == "las" || space == "left-anterior-superior")
        turn_round(header, 1);
      set_voxel_type(header, file, entries.needed_text({"type"}));
      header.big_endian          = lower_case(entries.text({"endian"})) == "big";
      const std::string encoding = lower_case(entries.needed_text({"encoding"}));
      header.compressed          = encoding == "gzip" || encoding == "gz";
      if (!header.compressed && encoding != "raw")
        refuse_image(file, "its encoding is " + encoding + "; write it with encoding raw or gzip.");
      header.data_file = entries.text({"data file", "datafile"});
      if (header.data_file.empty())
        header.data_start = end + (content.compare(end, 2, "\n\n") == 0 ? 2 : 3);
      return header;
    }

    ImageHeader nifti_header(const std::string &file, const std::string &content)
    {
      if (content.size() < 352 || content.compare(344, 3, "n+1") != 0)
        refuse_image(
          file, "it is no single-file NIfTI-1 image: write it as .nii or .nii.gz of version 1.");
      ImageHeader header;
      header.big_endian  = unsigned_number(&content[0], 4, true) == 348;
      const auto integer = [&](const std::size_t at) {
        return signed_number(&content[at], 2, header.big_endian);
      };
      const auto real = [&](const std::size_t at) {
        const std::uint32_t bits = unsigned_number(&content[at], 4, header.big_endian);
        float value;
        std::memcpy(&value, &bits, 4);
        return static_cast<double>(value);
      };

      for (unsigned int d = 0; d < dim; ++d)
        header.size[d] = integer(42 + 2 * d);
      if (integer(40) < 3 || (integer(40) > 3 && integer(48) != 1))
        refuse_image(file, "it has " + std::to_string(integer(40)) +
                             " dimensions; a segmentation has three.");
      static const std::map<int, const char *> types = {
        {2, "uint8"},  {4, "int16"},    {8, "int32"},    {16, "float"},   {64, "double"},
        {256, "int8"}, {512, "uint16"}, {768, "uint32"}, {1024, "int64"}, {1280, "uint64"}};
      const auto type = types.find(integer(70));
      set_voxel_type(header, file,
                     type == types.end() ? "number " + std::to_string(integer(70)) : type->second);
      header.data_start = real(108) >= 352 && real(108) < 1e9 ? real(108) : 352;

      header.steps = axis_steps(file, {real(80), real(84), real(88)});
      if (integer(254) > 0) // sform: the rows of the matrix
        for (unsigned int row = 0; row < dim; ++row)
        {
          for (unsigned int d = 0; d < dim; ++d)
            header.steps[d][row] = real(280 + 16 * row + 4 * d);
          header.origin[row] = real(292 + 16 * row);
        }
      else if (integer(252) > 0) // qform: a quaternion (a, b, c, d)
      {
        const double b = real(256), c = real(260), d = real(264), a2 = 1 - b * b - c * c - d * d;
        const double a = std::sqrt(std::max(0., a2)), flip = real(76) < 0 ? -1 : 1;
        header.steps[0] =
          Direction({a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)}) *
          real(80);
        header.steps[1] =
          Direction({2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)}) *
          real(84);
        header.steps[2] =
          Direction({2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}) *
          (flip * real(88));
        header.origin = Point(real(268), real(272), real(276));
      }
      else
        return header;
      turn_round(header, 0); // NIfTI's x points to the right, its y to the front
      turn_round(header, 1);
      return header;
    }
  } // namespace

  ImageHeader read_image_header(const std::string &file, const std::string &content)
  {
    static const std::map<std::string, ImageHeader (*)(const std::string &, const std::string &)>
      formats = {{".inr", inrimage_header}, {".mha", meta_header},  {".mhd", meta_header},
                 {".nrrd", nrrd_header},    {".nhdr", nrrd_header}, {".nii", nifti_header}};
    std::filesystem::path name = lower_case(file);
    if (name.extension() == ".gz")
      name.replace_extension();
    const auto format = formats.find(name.extension());
    if (format == formats.end())
      refuse_image(
        file, "the ending '" + name.extension().string() +
                "' is no image's that can be read; use .inr, .mha, .mhd, .nrrd, .nhdr or .nii.");
    return format->second(file, content);
  }
} // namespace softcell
