// SPDX-License-Identifier: LGPL-2.1-or-later
// Labelled segmentations: the voxels of a file.

#include <softcell/geometry/image.h>

#include "image_header.h"

#include <softcell/base/files.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <zlib.h>

namespace softcell
{
  namespace
  {
    std::string read_bytes(const std::string &place, const std::string &file)
    {
      check_file(place, file);
      std::ifstream in(file, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      return bytes.str();
    }

    /// Undoes zlib's or gzip's compression, of one stream or several in a row.
    std::string
    inflated(const std::string &file, const std::string &packed, const std::size_t start)
    {
      z_stream stream = {};
      if (inflateInit2(&stream, 15 + 32) != Z_OK) // 32: either kind
        throw std::bad_alloc();
      stream.next_in  = reinterpret_cast<Bytef *>(const_cast<char *>(packed.data() + start));
      stream.avail_in = packed.size() - start;
      std::string result;
      int status = Z_OK;
      while (status == Z_OK)
      {
        const std::size_t done = result.size();
        result.resize(std::max<std::size_t>(2 * done, 1 << 20));
        stream.next_out  = reinterpret_cast<Bytef *>(&result[done]);
        stream.avail_out = result.size() - done;
        status           = inflate(&stream, Z_NO_FLUSH);
        result.resize(result.size() - stream.avail_out);
        if (status == Z_STREAM_END && stream.avail_in > 0 && *stream.next_in == 0x1f)
          status = inflateReset(&stream);
      }
      inflateEnd(&stream);
      if (status != Z_STREAM_END)
        refuse_image(
          file, "its compressed data are damaged or cut short; fetch or write the file again.");
      return result;
    }

    /// The voxels' bytes, just as many as the header says.
    std::string read_voxels(const std::string &file, const ImageHeader &header, std::string content)
    {
      double n_bytes = header.bytes;
      for (const double n : header.size)
      {
        if (!(n >= 1 && n <= 65536 && n == std::floor(n)))
        {
          std::ostringstream text;
          text << "the header gives it " << std::setprecision(10) << n
               << " voxels along one axis, where 1 to 65536 can be; mend the header.";
          refuse_image(file, text.str());
        }
        n_bytes *= n;
      }
      std::string data_file = file;
      if (!header.data_file.empty())
      {
        data_file = std::filesystem::path(file).parent_path() / header.data_file;
        content =
          read_bytes("Geometry/File = " + file + ", whose header names its voxels", data_file);
      }
      const std::size_t start = std::min(header.data_start, content.size());
      content = header.compressed ? inflated(data_file, content, start) : content.substr(start);
      const double one_slice = n_bytes / header.size[2];
      if (content.size() < n_bytes || content.size() >= n_bytes + one_slice)
        refuse_image(data_file, "it has " + std::to_string(content.size()) +
                                  " bytes of voxels where its header announces " +
                                  std::to_string(static_cast<std::uint64_t>(n_bytes)) +
                                  (content.size() < n_bytes
                                     ? "; it is cut short, fetch or write it again."
                                     : "; mend the size or the voxel type in the header."));
      return content;
    }

    /// Where the voxels of a file go in an image whose axes run along x, y, z.
    struct Arrangement
    {
      std::array<std::size_t, 3> size; // of the file
      std::array<std::ptrdiff_t, 3>
        stride;             // in the image, from a voxel to the next of each index of the file
      std::ptrdiff_t first; // place of the file's first voxel
    };

    /// Sets all of the image but its values and voxels.
    Arrangement arrange(const std::string &file,
                        const ImageHeader &header,
                        const double scale,
                        LabelImage &image)
    {
      Arrangement result;
      std::array<unsigned int, 3> along; // x, y or z
      image.origin = Point(header.origin * scale);
      for (unsigned int axis = 0; axis < dim; ++axis)
      {
        const Direction &step = header.steps[axis];
        unsigned int d        = 0;
        for (unsigned int e = 1; e < dim; ++e)
          if (std::abs(step[e]) > std::abs(step[d]))
            d = e;
        const double length = step.norm();
        if (!(length > 0 && std::isfinite(length) && std::isfinite(image.origin.norm())))
          refuse_image(
            file,
            "the header places its voxels nowhere (a size of 0 or no number); mend the header.");
        if (std::abs(step[d]) < (1 - 1e-8) * length || (axis > 0 && image.spacing[d] > 0))
          refuse_image(
            file,
            "its axes are oblique to x, y and z; resample it to an axis-aligned image first.");
        along[axis]       = d;
        result.size[axis] = image.size[d] = header.size[axis];
        image.spacing[d]                  = std::abs(step[d]) * scale;
        if (step[d] < 0)
          image.origin[d] -= (header.size[axis] - 1) * image.spacing[d];
      }
      const std::array<std::ptrdiff_t, 3> strides = {
        {1, image.size[0], std::ptrdiff_t(image.size[0]) * image.size[1]}};
      result.first = 0;
      for (unsigned int axis = 0; axis < dim; ++axis)
      {
        const std::ptrdiff_t stride = strides[along[axis]];
        const bool flipped          = header.steps[axis][along[axis]] < 0;
        result.stride[axis]         = flipped ? -stride : stride;
        result.first += flipped ? stride * (image.size[along[axis]] - 1) : 0;
      }
      return result;
    }

    /// Replaces the values of n_bytes each by their indices in image.values.
    template <unsigned int n_bytes>
    void index_values(const std::string &file,
                      const ImageHeader &header,
                      const std::string &data,
                      const Arrangement &places,
                      LabelImage &image)
    {
      const char *in = data.data(), *last = nullptr;
      std::uint8_t index = 0;
      for (std::size_t k = 0; k < places.size[2]; ++k)
        for (std::size_t j = 0; j < places.size[1]; ++j)
        {
          std::uint8_t *out =
            image.voxels.data() + places.first + k * places.stride[2] + j * places.stride[1];
          for (std::size_t i = 0; i < places.size[0]; ++i, in += n_bytes, out += places.stride[0])
          {
            if (!last || std::memcmp(in, last, n_bytes) != 0)
            {
              last                     = in;
              const std::int64_t value = header.is_signed
                                           ? signed_number(in, n_bytes, header.big_endian)
                                           : unsigned_number(in, n_bytes, header.big_endian);
              const auto found         = std::find(image.values.begin(), image.values.end(), value);
              index                    = found - image.values.begin();
              if (found == image.values.end())
                image.values.push_back(value);
              if (image.values.size() > 255)
                refuse_image(file,
                             "it holds more than 255 different values, so it is a picture and no "
                             "segmentation; give "
                             "the file of labels.");
            }
            *out = index;
          }
        }
    }
  } // namespace

  LabelImage read_image(const std::string &file, const double scale)
  {
    std::string content = read_bytes("Geometry/File = " + file, file);
    if (content.compare(0, 2, "\x1f\x8b") == 0)
      content = inflated(file, content, 0);
    const ImageHeader header = read_image_header(file, content);
    const std::string data   = read_voxels(file, header, std::move(content));

    LabelImage image;
    const Arrangement places = arrange(file, header, scale, image);
    image.voxels.resize(std::size_t(image.size[0]) * image.size[1] * image.size[2]);
    switch (header.bytes)
    {
      case 1:
        index_values<1>(file, header, data, places, image);
        break;
      case 2:
        index_values<2>(file, header, data, places, image);
        break;
      case 4:
        index_values<4>(file, header, data, places, image);
        break;
      default:
        index_values<8>(file, header, data, places, image);
    }
    return image;
  }

  std::string voxel_file(const std::string &file)
  {
    const std::filesystem::path path = file;
    std::string ending               = path.extension();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](const unsigned char c) { return std::tolower(c); });
    if (ending != ".mhd" && ending != ".mha" && ending != ".nhdr" && ending != ".nrrd")
      return "";
    const std::string name =
      read_image_header(file, read_bytes("Geometry/File = " + file, file)).data_file;
    return name.empty() ? "" : path.parent_path() / name;
  }
} // namespace softcell
