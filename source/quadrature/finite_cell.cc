// SPDX-License-Identifier: LGPL-2.1-or-later
// The finite cell rule: Gauss points on the leaves of an octree.

#include <softcell/quadrature/finite_cell.h>

#include <deal.II/base/quadrature_lib.h>

namespace softcell
{
  FiniteCell::FiniteCell(const CutParameters &parameters,
                         const unsigned int degree,
                         const Body &body)
      : body_(body),
        parameters_(parameters),
        gauss_(dealii::QGauss<3>(degree + 1)),
        mask_bytes_((gauss_.size() + 7) / 8),
        cells_(1)
  {
    Assert(parameters.levels >= 1 && parameters.levels <= max_levels, dealii::ExcInternalError());
  }

  double FiniteCell::add(const Box &cell)
  {
    const auto &[lower, upper] = cell.get_boundary_points();
    cells_.back().lower        = lower;
    cells_.back().size         = upper - lower;

    double volume = 0;
    visit_leaves(body_, cell, parameters_.levels,
                 [&](const Box &leaf, const Side side, const LeafCode code) {
                   if (side == Side::cut)
                     add_cut_leaf(leaf, code, volume);
                   else if (side == Side::inside)
                   {
                     full_.push_back(code);
                     volume += leaf.volume();
                   }
                 });
    cells_.push_back({Point(), Direction(), full_.size(), cut_.size()});

    std::vector<unsigned char> labels;
    if (body_.n_labels() > 1)
    {
      CutPoints result;
      place_points(cells_.end()[-2], cells_.back(), result);
      for (const Point &q : result.points)
        labels.push_back(body_.label(cell.unit_to_real(q)));
    }
    labels_.add(labels.empty() ? std::vector<unsigned char>{0} : labels);
    return volume;
  }

  void FiniteCell::add_cut_leaf(const Box &leaf, const LeafCode code, double &volume)
  {
    std::vector<unsigned char> mask(mask_bytes_, 0);
    unsigned int n_inside = 0;
    for (unsigned int i = 0; i < gauss_.size(); ++i)
      if (body_.contains(leaf.unit_to_real(gauss_.point(i))))
      {
        mask[i / 8] |= 1 << i % 8;
        volume += gauss_.weight(i) * leaf.volume();
        ++n_inside;
      }

    if (n_inside == gauss_.size())
      full_.push_back(code);
    else if (n_inside > 0)
    {
      cut_.push_back(code);
      masks_.insert(masks_.end(), mask.begin(), mask.end());
    }
  }

  void FiniteCell::points(const unsigned int index, CutPoints &result) const
  {
    place_points(cells_[index], cells_[index + 1], result);
    const auto labels = labels_[index];
    result.labels.assign(labels.begin(), labels.end());
  }

  void FiniteCell::place_points(const Cell &cell, const Cell &next, CutPoints &result) const
  {
    result.points.clear();
    result.weights.clear();
    const double volume = cell.size[0] * cell.size[1] * cell.size[2];

    const auto place_leaf = [&](LeafCode code, const auto &is_inside) {
      std::array<unsigned int, 3> index = {{0, 0, 0}};
      unsigned int n                    = 1; // leaves of this size along an edge of the cell
      for (; code > 1; code >>= 3, n *= 2)
        for (unsigned int d = 0; d < 3; ++d)
          index[d] += (code >> d & 1) * n;

      const double h           = 1. / n;
      const double leaf_volume = volume * h * h * h;
      const Point lower(h * index[0], h * index[1], h * index[2]);
      for (unsigned int i = 0; i < gauss_.size(); ++i)
        if (is_inside(i))
        {
          result.points.push_back(lower + h * gauss_.point(i));
          result.weights.push_back(leaf_volume * gauss_.weight(i));
        }
    };

    for (std::size_t leaf = cell.full; leaf < next.full; ++leaf)
      place_leaf(full_[leaf], [](unsigned int) { return true; });
    for (std::size_t leaf = cell.cut; leaf < next.cut; ++leaf)
      place_leaf(cut_[leaf], [&](const unsigned int i) { return is_inside(leaf, i); });
  }
} // namespace softcell
