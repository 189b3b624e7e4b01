// SPDX-License-Identifier: LGPL-2.1-or-later
// Material labels of the points of many cells.
#pragma once

#include <softcell/base/types.h>

#include <algorithm>
#include <vector>

namespace softcell
{
  /// Labels of one cell after the other; a cell of one material takes one byte.
  class LabelList
  {
  public:
    void add(const std::vector<unsigned char> &labels)
    {
      const bool uniform =
        std::all_of(labels.begin(), labels.end(),
                    [&](const unsigned char label) { return label == labels.front(); });
      labels_.insert(labels_.end(), labels.begin(), uniform ? labels.begin() + 1 : labels.end());
      starts_.push_back(labels_.size());
    }

    /// The labels of a cell's points, or the single one of all of them.
    View<const unsigned char> operator[](const unsigned int cell) const
    {
      return {labels_.data() + starts_[cell], starts_[cell + 1] - starts_[cell]};
    }

  private:
    std::vector<unsigned char> labels_;
    std::vector<std::size_t> starts_ = {0};
  };
} // namespace softcell
