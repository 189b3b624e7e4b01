// SPDX-License-Identifier: LGPL-2.1-or-later
// What is done for every entry of vectors, and sums over them, for host and device.
#pragma once

#include <softcell/mechanics/tensor.h>

#include <cstddef>

namespace softcell
{
  /// Calls an action for every entry of a vector.
  template <class Action>
  struct EntryKernel
  {
    using Scratch = char;

    static constexpr int n_threads = 256, n_phases = 1, n_scratch = 0;

    Action action;
    std::size_t size;

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const std::size_t i = std::size_t(block) * n_threads + thread;
      if (i < size)
        action(i);
    }
  };

  /// Sums over the entries of vectors, one in each block: terms(i) is what entry i adds.
  template <class Terms>
  struct SumKernel
  {
    using Scratch = double;

    static constexpr int n_threads = 256, n_phases = 9, n_scratch = n_threads; // 2^(9-1) threads

    Terms terms;
    std::size_t size;
    int n_blocks;
    double *sums; // (n_blocks)

    SOFTCELL_HOST_DEVICE void
    operator()(const int phase, const int block, const int thread, double *const scratch) const
    {
      if (phase == 0)
      {
        double sum = 0;
        for (std::size_t i = std::size_t(block) * n_threads + thread; i < size;
             i += std::size_t(n_blocks) * n_threads)
          sum += terms(i);
        scratch[thread] = sum;
        return;
      }
      const int half = n_threads >> phase;
      if (thread < half)
        scratch[thread] += scratch[thread + half];
      if (half == 1 && thread == 0)
        sums[block] = scratch[0];
    }
  };

  template <class Device, class Action>
  void for_each_entry(const Action &action, const std::size_t size)
  {
    using Kernel = EntryKernel<Action>;
    Device::launch(Kernel{action, size}, (size + Kernel::n_threads - 1) / Kernel::n_threads);
  }
} // namespace softcell
