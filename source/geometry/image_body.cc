// SPDX-License-Identifier: LGPL-2.1-or-later
// The body that chosen labels of a segmentation form.

#include <softcell/geometry/image_body.h>

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace softcell
{
  namespace
  {
    /// Pieces smaller than this part of the largest one are stray voxels.
    constexpr double stray = 1e-3;

    /// So many voxels around a point outside are searched for a label.
    constexpr long search_radius = 8;

    /// The labels that form the body.
    struct Selection
    {
      std::array<std::uint8_t, 256> label_of_value; // label + 1; 0: outside
      std::vector<std::string> names;
    };

    Selection select(const LabelImage &image,
                     const std::vector<unsigned int> &labels,
                     const std::string &name)
    {
      std::array<std::size_t, 256> counts = {};
      for (const std::uint8_t voxel : image.voxels)
        ++counts[voxel];

      std::map<std::int64_t, unsigned int> present; // value, index
      for (unsigned int i = 0; i < image.values.size(); ++i)
        if (image.values[i] != 0 && counts[i] > 0)
          present[image.values[i]] = i;
      std::ostringstream holds;
      for (const auto &[value, index] : present)
        holds << (holds.tellp() > 0 ? ", " : "") << value << " (" << counts[index] << " voxels)";
      if (present.empty())
        throw BadInput(name + ": all its voxels have label 0, the background; it holds no body.");

      std::vector<std::int64_t> chosen(labels.begin(), labels.end());
      if (labels.empty())
        for (const auto &[value, index] : present)
          chosen.push_back(value);

      Selection result = {{}, {}};
      for (const std::int64_t value : chosen)
      {
        const auto found = present.find(value);
        if (found == present.end())
          throw BadInput(name + ": no voxel has label " + std::to_string(value) +
                         " of Geometry/Labels; it holds " + holds.str() + ".");
        if (result.label_of_value[found->second] != 0)
          throw BadInput("Geometry/Labels names label " + std::to_string(value) +
                         " twice; name it once.");
        result.names.push_back(std::to_string(value));
        result.label_of_value[found->second] = result.names.size();
      }
      return result;
    }

    /// Visits all voxels that hang together with the first by faces and have not been visited.
    template <class Visit>
    void flood(const LabelImage &image,
               const std::size_t first,
               std::vector<bool> &visited,
               const Visit &visit)
    {
      const std::array<std::size_t, 3> size   = {{image.size[0], image.size[1], image.size[2]}};
      const std::array<std::size_t, 3> stride = {{1, size[0], size[0] * size[1]}};
      std::vector<std::size_t> front          = {first};
      visited[first]                          = true;
      while (!front.empty())
      {
        const std::size_t at = front.back();
        front.pop_back();
        visit(at);
        for (unsigned int d = 0; d < dim; ++d)
        {
          const std::size_t i = at / stride[d] % size[d];
          for (const bool up : {false, true})
            if (up ? i + 1 < size[d] : i > 0)
            {
              const std::size_t next = up ? at + stride[d] : at - stride[d];
              if (image.voxels[next] != 0 && !visited[next])
              {
                visited[next] = true;
                front.push_back(next);
              }
            }
        }
      }
    }

    /// Sets the voxels of stray pieces to 0.
    void
    drop_stray_pieces(LabelImage &image, const std::string &name, std::vector<std::string> &remarks)
    {
      struct Piece
      {
        std::size_t first, n_voxels;
      };
      std::vector<Piece> pieces;
      std::vector<bool> visited(image.voxels.size());
      for (std::size_t v = 0; v < image.voxels.size(); ++v)
        if (image.voxels[v] != 0 && !visited[v])
        {
          pieces.push_back({v, 0});
          flood(image, v, visited, [&](std::size_t) { ++pieces.back().n_voxels; });
        }
      std::size_t largest = 0, n_dropped = 0, dropped_voxels = 0;
      for (const Piece &piece : pieces)
        largest = std::max(largest, piece.n_voxels);

      visited.assign(visited.size(), false);
      for (const Piece &piece : pieces)
        if (piece.n_voxels < stray * largest)
        {
          ++n_dropped;
          dropped_voxels += piece.n_voxels;
          flood(image, piece.first, visited, [&](const std::size_t v) { image.voxels[v] = 0; });
        }
      if (n_dropped > 0)
        remarks.push_back(name + ": left out " + std::to_string(dropped_voxels) +
                          " stray voxels in " + std::to_string(n_dropped) +
                          " piece(s) apart from the body.");
      if (pieces.size() - n_dropped > 1)
        remarks.push_back(name + ": the body is in " + std::to_string(pieces.size() - n_dropped) +
                          " pieces that do not touch; each must be held where it is loaded.");
    }
  } // namespace

  ImageBody::ImageBody(LabelImage image,
                       const std::vector<unsigned int> &labels,
                       const std::string &name,
                       std::vector<std::string> &remarks)
      : spacing_(image.spacing)
  {
    Selection selection = select(image, labels, name);
    names_              = std::move(selection.names);
    for (std::uint8_t &voxel : image.voxels)
      voxel = selection.label_of_value[voxel];
    drop_stray_pieces(image, name, remarks);

    const std::size_t n_x = image.size[0], n_y = image.size[1];
    Index low = image.size, high = {{0, 0, 0}};
    for (std::size_t v = 0; v < image.voxels.size(); ++v)
      if (image.voxels[v] != 0)
      {
        const std::array<std::size_t, 3> index = {{v % n_x, v / n_x % n_y, v / n_x / n_y}};
        for (unsigned int d = 0; d < dim; ++d)
        {
          low[d]  = std::min<std::size_t>(low[d], index[d]);
          high[d] = std::max<std::size_t>(high[d], index[d] + 1);
        }
      }
    for (unsigned int d = 0; d < dim; ++d)
    {
      size_[d]  = high[d] - low[d];
      lower_[d] = image.origin[d] + (low[d] - 0.5) * spacing_[d];
    }
    labels_.reserve(std::size_t(size_[0]) * size_[1] * size_[2]);
    for (std::size_t k = low[2]; k < high[2]; ++k)
      for (std::size_t j = low[1]; j < high[1]; ++j)
      {
        const auto row = image.voxels.begin() + (k * n_y + j) * n_x;
        labels_.insert(labels_.end(), row + low[0], row + high[0]);
      }

    filled_ = sum_up([](const std::uint8_t voxel) { return voxel != 0; });
    for (unsigned int bit = 0; (names_.size() - 1) >> bit != 0; ++bit)
      with_bit_.push_back(sum_up(
        [&](const std::uint8_t voxel) { return voxel != 0 && ((voxel - 1) >> bit & 1) != 0; }));
  }

  template <class Counts>
  ImageBody::Sums ImageBody::sum_up(const Counts &counts) const
  {
    const std::size_t row = size_[0] + 1, slice = row * (size_[1] + 1);
    Sums sums(slice * (size_[2] + 1), 0);
    const std::uint8_t *voxel = labels_.data();
    for (unsigned int k = 1; k <= size_[2]; ++k)
      for (unsigned int j = 1; j <= size_[1]; ++j)
      {
        std::uint32_t *sum          = &sums[k * slice + j * row];
        const std::uint32_t *before = sum - row, *below = sum - slice, *both = below - row;
        std::uint32_t in_row = 0;
        for (unsigned int i = 1; i <= size_[0]; ++i)
        {
          in_row += counts(*voxel++);
          sum[i] = in_row + before[i] + below[i] - both[i];
        }
      }
    return sums;
  }

  Box ImageBody::bounding_box() const
  {
    Point upper = lower_;
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] += size_[d] * spacing_[d];
    return Box({lower_, upper});
  }

  std::uint8_t ImageBody::at(const long i, const long j, const long k) const
  {
    const bool is_in = i >= 0 && j >= 0 && k >= 0 && i < size_[0] && j < size_[1] && k < size_[2];
    return is_in ? labels_[(std::size_t(k) * size_[1] + j) * size_[0] + i] : 0;
  }

  bool ImageBody::contains(const Point &X) const
  {
    const Direction x = X - lower_;
    return at(std::floor(x[0] / spacing_[0]), std::floor(x[1] / spacing_[1]),
              std::floor(x[2] / spacing_[2])) != 0;
  }

  std::array<ImageBody::Range, 3> ImageBody::in_voxels(const Box &box) const
  {
    const auto in_voxel = [&](const Point &X, const unsigned int d) {
      const double x = (X[d] - lower_[d]) / spacing_[d], whole = std::round(x);
      return std::abs(x - whole) < 1e-9 ? whole : x;
    };
    const auto &[low, high] = box.get_boundary_points();
    std::array<Range, 3> ranges;
    for (unsigned int d = 0; d < dim; ++d)
      ranges[d] = {in_voxel(low, d), in_voxel(high, d)};
    return ranges;
  }

  std::uint32_t ImageBody::count(const Sums &sums, const Index &low, const Index &high) const
  {
    const std::size_t row = size_[0] + 1, slice = row * (size_[1] + 1);
    const auto in_slice = [&](const unsigned int k) {
      const std::uint32_t *lower = &sums[k * slice + low[1] * row],
                          *upper = &sums[k * slice + high[1] * row];
      return upper[high[0]] - upper[low[0]] - lower[high[0]] + lower[low[0]];
    };
    return in_slice(high[2]) - in_slice(low[2]);
  }

  Side ImageBody::classify(const Box &box) const
  {
    const auto ranges = in_voxels(box);
    bool may_fill     = true;
    Index low, high;
    std::size_t n_voxels = 1;
    for (unsigned int d = 0; d < dim; ++d)
    {
      const double end = size_[d];
      may_fill         = may_fill && ranges[d].low >= 0 && ranges[d].high <= end;
      low[d]           = std::floor(std::clamp(ranges[d].low, 0., end));
      high[d]          = std::ceil(std::clamp(ranges[d].high, 0., end));
      n_voxels *= high[d] - low[d];
    }
    const std::uint32_t n_filled = count(filled_, low, high);
    if (n_filled == 0)
      return Side::outside;
    const bool has_one_label =
      std::all_of(with_bit_.begin(), with_bit_.end(), [&](const Sums &sums) {
        const std::uint32_t n = count(sums, low, high);
        return n == 0 || n == n_filled;
      });
    return may_fill && n_filled == n_voxels && has_one_label ? Side::inside : Side::cut;
  }

  double ImageBody::filled_volume(const Box &box) const
  {
    // Along each axis, a piece of the first voxel, whole voxels, and a piece of the last one. All
    // weights are positive, so that no digits cancel however small the box is.
    struct Piece
    {
      unsigned int low, high;
      double part;
    };
    const auto ranges = in_voxels(box);
    std::array<std::vector<Piece>, 3> pieces;
    for (unsigned int d = 0; d < dim; ++d)
    {
      const double low  = std::clamp<double>(ranges[d].low, 0, size_[d]);
      const double high = std::clamp<double>(ranges[d].high, 0, size_[d]);
      if (low >= high)
        return 0;
      const unsigned int first = std::floor(low), last = std::ceil(high) - 1;
      if (first == last)
        pieces[d] = {{first, first + 1, high - low}};
      else
        pieces[d] = {
          {first, first + 1, first + 1 - low}, {first + 1, last, 1}, {last, last + 1, high - last}};
    }
    double n_voxels = 0;
    for (const Piece &x : pieces[0])
      for (const Piece &y : pieces[1])
        for (const Piece &z : pieces[2])
          n_voxels += x.part * y.part * z.part *
                      count(filled_, {{x.low, y.low, z.low}}, {{x.high, y.high, z.high}});
    return n_voxels * spacing_[0] * spacing_[1] * spacing_[2];
  }

  double ImageBody::volume() const
  {
    return filled_.back() * spacing_[0] * spacing_[1] * spacing_[2];
  }

  unsigned int ImageBody::n_labels() const
  {
    return names_.size();
  }

  unsigned int ImageBody::label(const Point &X) const
  {
    if (names_.size() == 1)
      return 0;
    std::array<long, 3> v;
    for (unsigned int d = 0; d < dim; ++d)
      v[d] = std::clamp<double>(std::floor((X[d] - lower_[d]) / spacing_[d]), 0, size_[d] - 1);
    for (long r = 0; r <= search_radius; ++r)
    {
      double nearest     = std::numeric_limits<double>::max();
      std::uint8_t found = 0;
      for (long k = -r; k <= r; ++k)
        for (long j = -r; j <= r; ++j)
          for (long i = -r; i <= r; ++i)
            if (const std::uint8_t label = at(v[0] + i, v[1] + j, v[2] + k))
            {
              const double distance =
                Direction({i * spacing_[0], j * spacing_[1], k * spacing_[2]}).norm();
              if (distance < nearest)
              {
                nearest = distance;
                found   = label;
              }
            }
      if (found != 0)
        return found - 1;
    }
    return 0;
  }

  std::string ImageBody::label_name(const unsigned int label) const
  {
    return names_[label];
  }
} // namespace softcell
