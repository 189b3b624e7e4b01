// SPDX-License-Identifier: LGPL-2.1-or-later
// Sorts the points of the finite cell by materials and compresses each set.

#include <softcell/quadrature/moment_fitting.h>

#include <softcell/base/exceptions.h>
#include <softcell/quadrature/finite_cell.h>

#include <cmath>

namespace softcell
{
  MomentFitting::MomentFitting(const CutParameters &parameters,
                               const unsigned int degree,
                               const Body &body)
      : body_(body), parameters_(parameters), degree_(degree), compression_(degree)
  {
    constexpr unsigned int max_degree = 3;
    if (degree > max_degree)
      throw BadInput("Discretization/Degree = " + std::to_string(degree) +
                     " is too high for moment fitting, which would search for minutes in each cut "
                     "cell; give at most 3, or 'Method = finite cell'.");
  }

  double MomentFitting::add(const Box &cell)
  {
    FiniteCell finite_cell(parameters_, degree_, body_);
    const double volume = finite_cell.add(cell);
    CutPoints all;
    finite_cell.points(0, all);

    const double n_few = std::pow(degree_ + 1, 3);
    bool has_failed    = false;
    std::vector<unsigned char> labels;
    for (unsigned int label = 0; label < body_.n_labels(); ++label)
    {
      std::vector<Point> points;
      std::vector<double> weights;
      for (unsigned int q = 0; q < all.points.size(); ++q)
        if (all.labels[all.labels.size() == 1 ? 0 : q] == label)
        {
          points.push_back(all.points[q]);
          weights.push_back(all.weights[q]);
        }
      compression_.compress(points, weights);
      has_failed = has_failed || points.size() > n_few;
      points_.insert(points_.end(), points.begin(), points.end());
      weights_.insert(weights_.end(), weights.begin(), weights.end());
      labels.insert(labels.end(), points.size(), label);
    }
    n_failures_ += has_failed;
    starts_.push_back(points_.size());
    labels_.add(labels.empty() ? std::vector<unsigned char>{0} : labels);
    return volume;
  }

  void MomentFitting::points(const unsigned int index, CutPoints &result) const
  {
    const std::size_t begin = starts_[index], end = starts_[index + 1];
    result.points.assign(points_.begin() + begin, points_.begin() + end);
    result.weights.assign(weights_.begin() + begin, weights_.begin() + end);
    const auto labels = labels_[index];
    result.labels.assign(labels.begin(), labels.end());
  }
} // namespace softcell
