// SPDX-License-Identifier: LGPL-2.1-or-later
// The weighted cell rule: the cell's own Gauss points, weighted by what is filled around them.

#include <softcell/quadrature/weighted_cell.h>

#include <softcell/quadrature/octree.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

namespace softcell
{
  WeightedCell::WeightedCell(const CutParameters &parameters,
                             const unsigned int degree,
                             const Body &body)
      : body_(body), parameters_(parameters), gauss_(dealii::QGauss<3>(degree + 1))
  {
    Assert(parameters.levels <= max_levels, dealii::ExcInternalError());
    const unsigned int n = degree + 1;
    const dealii::QGauss<1> line(n);
    std::vector<double> ends(1, 0.);
    for (const double w : line.get_weights())
      ends.push_back(ends.back() + w);
    ends.back() = 1;
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          parts_.push_back(
            Box({Point(ends[i], ends[j], ends[k]), Point(ends[i + 1], ends[j + 1], ends[k + 1])}));
  }

  double WeightedCell::add(const Box &cell)
  {
    const double cell_volume = cell.volume();
    std::vector<double> fractions(gauss_.size(), 1.);
    std::vector<unsigned char> labels;
    double volume = 0;
    for (unsigned int i = 0; i < gauss_.size(); ++i)
    {
      const Point X = cell.unit_to_real(gauss_.point(i));
      labels.push_back(body_.label(X));
      if (parameters_.levels > 0)
      {
        const auto &[lower, upper] = parts_[i].get_boundary_points();
        const Filled v = filled(Box({cell.unit_to_real(lower), cell.unit_to_real(upper)}), X);
        fractions[i]   = v.fraction;
        labels.back()  = v.label;
        volume += v.fraction * gauss_.weight(i) * cell_volume;
      }
    }
    if (parameters_.levels == 0 && body_.filled_volume(cell) > 1e-9 * cell_volume)
      volume = cell_volume;

    steady({fractions.data(), fractions.size()}, volume / cell_volume, parameters_.spread);
    for (unsigned int i = 0; i < gauss_.size(); ++i)
      weights_.push_back(fractions[i] * gauss_.weight(i) * cell_volume);
    labels_.add(labels);
    return volume;
  }

  void WeightedCell::steady(const View<double> fractions, const double mean, const double spread)
  {
    const double largest    = *std::max_element(fractions.begin(), fractions.end());
    const auto n_weighty    = std::count_if(fractions.begin(), fractions.end(),
                                            [&](const double v) { return v > 0.1 * largest; });
    const bool is_mechanism = std::size_t(n_weighty) < fractions.size() / 2;
    if (is_mechanism)
      for (double &v : fractions)
        v += spread * (mean - v);
  }

  WeightedCell::Filled WeightedCell::filled(const Box &part, const Point &gauss_point) const
  {
    double fraction = 0;
    std::vector<double> fraction_of(body_.n_labels(), 0.);
    visit_leaves(body_, part, parameters_.levels - 1,
                 [&](const Box &leaf, const Side side, const LeafCode) {
                   if (side == Side::outside)
                     return;
                   const double leaf_fraction = leaf.volume() / part.volume();
                   if (side == Side::inside)
                   {
                     fraction += leaf_fraction;
                     fraction_of[body_.label(leaf.center())] += leaf_fraction;
                     return;
                   }
                   for (unsigned int i = 0; i < gauss_.size(); ++i)
                   {
                     const Point X = leaf.unit_to_real(gauss_.point(i));
                     if (!body_.contains(X))
                       continue;
                     fraction += gauss_.weight(i) * leaf_fraction;
                     fraction_of[body_.label(X)] += gauss_.weight(i) * leaf_fraction;
                   }
                 });
    if (fraction == 0)
      return {fraction, static_cast<unsigned char>(body_.label(gauss_point))};
    return {fraction,
            static_cast<unsigned char>(std::max_element(fraction_of.begin(), fraction_of.end()) -
                                       fraction_of.begin())};
  }

  void WeightedCell::points(const unsigned int index, CutPoints &result) const
  {
    const double *begin = weights_.data() + std::size_t(index) * gauss_.size();
    result.weights.assign(begin, begin + gauss_.size());
    const auto labels = labels_[index];
    result.labels.assign(labels.begin(), labels.end());
  }
} // namespace softcell
