// SPDX-License-Identifier: LGPL-2.1-or-later
// What a graphics card can calculate at most.
#pragma once

#include <softcell/mechanics/tensor.h>

namespace softcell
{
  /// Fused multiplications and additions in registers.
  template <class Real>
  struct FusedKernel
  {
    using Scratch = char;

    static constexpr int n_threads = 256, n_phases = 1, n_scratch = 0;
    static constexpr int n_chains = 8, n_steps = 4096; // of a thread

    Real *results; // (blocks, n_threads)

    SOFTCELL_HOST_DEVICE void
    operator()(int /*phase*/, const int block, const int thread, char * /*scratch*/) const
    {
      const Real a(0.999), b(0.001);
      Real x[n_chains];
      for (int k = 0; k < n_chains; ++k)
        x[k] = thread + k;
      for (int step = 0; step < n_steps; ++step)
        for (Real &chain : x)
          chain = a * chain + b;
      Real sum = 0;
      for (const Real chain : x)
        sum += chain;
      results[block * n_threads + thread] = sum;
    }
  };
} // namespace softcell
