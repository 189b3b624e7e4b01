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

  /// Sums over the entries of vectors, one in each block: terms(i, sums) adds what entry i has for
  /// Terms::n_sums sums.
  template <class Terms>
  struct SumKernel
  {
    using Scratch = double;

    static constexpr int n_threads = 256, n_phases = 9, n_sums = Terms::n_sums; // 2^(9-1) threads
    static constexpr int n_scratch = n_sums * n_threads;

    Terms terms;
    std::size_t size;
    int n_blocks;
    double *results; // (n_sums, n_blocks)

    SOFTCELL_HOST_DEVICE void
    operator()(const int phase, const int block, const int thread, double *const scratch) const
    {
      if (phase == 0)
      {
        double sums[n_sums] = {};
        for (std::size_t i = std::size_t(block) * n_threads + thread; i < size;
             i += std::size_t(n_blocks) * n_threads)
          terms(i, sums);
        for (int k = 0; k < n_sums; ++k)
          scratch[k * n_threads + thread] = sums[k];
        return;
      }
      const int half = n_threads >> phase;
      if (thread < half)
        for (int k = 0; k < n_sums; ++k)
        {
          scratch[k * n_threads + thread] += scratch[k * n_threads + thread + half];
          if (half == 1)
            results[k * n_blocks + block] = scratch[k * n_threads];
        }
    }
  };

  /// The sums of blocks.
  template <int n>
  struct BlockTerms
  {
    static constexpr int n_sums = n;

    const double *block_sums; // (n, n_blocks)
    int n_blocks;

    SOFTCELL_HOST_DEVICE void operator()(const std::size_t i, double *const sums) const
    {
      for (int k = 0; k < n; ++k)
        sums[k] += block_sums[k * n_blocks + i];
    }
  };

  template <class Device, class Action>
  void for_each_entry(const Action &action, const std::size_t size)
  {
    using Kernel = EntryKernel<Action>;
    Device::launch(Kernel{action, size}, (size + Kernel::n_threads - 1) / Kernel::n_threads);
  }
} // namespace softcell
