// SPDX-License-Identifier: LGPL-2.1-or-later
// The devices on which kernels are tested, and what goes between them and the host.
#pragma once

#include <softcell/base/device.h>
#include <softcell/base/types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace softcell
{
#ifdef SOFTCELL_CUDA
  using Devices = ::testing::Types<Serial, Cuda>;
#else
  using Devices = ::testing::Types<Serial>;
#endif

  /// Base of a fixture of TYPED_TEST_SUITE(..., Devices, DeviceNames).
  template <class Device>
  class DeviceTest : public ::testing::Test
  {
  protected:
    void SetUp() override
    {
      if (!Device::is_there())
        GTEST_SKIP() << "There is no graphics card.";
    }
  };

  struct DeviceNames
  {
    template <class Device>
    static std::string GetName(int /*number*/)
    {
      return std::is_same_v<Device, Serial> ? "Serial" : "Cuda";
    }
  };

  template <class T, class Device>
  std::vector<T> on_host(const DeviceArray<T, Device> &values)
  {
    std::vector<T> result(values.size());
    values.copy_to(result.data());
    return result;
  }

  /// The largest difference, relative to the largest value.
  template <class T, class Device>
  double difference(const DeviceArray<T, Device> &a, const View<const T> b)
  {
    const std::vector<T> values = on_host(a);
    double difference = 0, largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      difference = std::max<double>(difference, std::abs(values[i] - b[i]));
      largest    = std::max<double>(largest, std::abs(b[i]));
    }
    return difference / largest;
  }
} // namespace softcell
