// SPDX-License-Identifier: LGPL-2.1-or-later
// What is said of points that are turned inside out.
#pragma once

#include <softcell/base/device.h>
#include <softcell/base/exceptions.h>

#include <numeric>
#include <string>

namespace softcell
{
  /// @throws InvertedPoint unless n is 0.
  inline void throw_if_inverted(const std::size_t n)
  {
    if (n > 0)
      throw InvertedPoint(std::to_string(n) +
                          (n == 1 ? " integration point is" : " integration points are") +
                          " turned inside out (J <= 0).");
  }

  /// @throws InvertedPoint unless all counts are 0.
  template <class Device>
  void throw_if_inverted(const DeviceArray<int, Device> &counts)
  {
    std::vector<int> numbers(counts.size());
    counts.copy_to(numbers.data());
    throw_if_inverted(std::accumulate(numbers.begin(), numbers.end(), std::size_t(0)));
  }
} // namespace softcell
