// SPDX-License-Identifier: LGPL-2.1-or-later
// How kernels are run; for sources that define kernels.
#pragma once

#include <softcell/base/device.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace softcell
{
  /// What is shared is NaN (or the largest number) at first, and from block to block and from phase
  /// to phase the first or the last thread begins, so that a kernel that relies on an order gives
  /// something wrong.
  template <class Kernel>
  void Serial::launch(const Kernel &kernel, const std::size_t n_blocks)
  {
    using Limits = std::numeric_limits<typename Kernel::Scratch>;
    std::vector<typename Kernel::Scratch> scratch(Kernel::n_scratch);
    for (unsigned int block = 0; block < n_blocks; ++block)
    {
      scratch.assign(scratch.size(), Limits::has_quiet_NaN ? Limits::quiet_NaN() : Limits::max());
      for (int phase = 0; phase < Kernel::n_phases; ++phase)
        for (unsigned int i = 0; i < Kernel::n_threads; ++i)
          kernel(phase, block, (phase + block) % 2 == 0 ? i : Kernel::n_threads - 1 - i,
                 scratch.data());
    }
  }

#ifdef __CUDACC__
  /// @throws std::runtime_error if a call of CUDA has failed.
  inline void check_cuda(const cudaError_t error)
  {
    if (error != cudaSuccess)
      throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(error));
  }

  template <class Kernel, class = void>
  constexpr int min_blocks = 0;
  template <class Kernel>
  constexpr int min_blocks<Kernel, std::void_t<decltype(Kernel::min_blocks)>> = Kernel::min_blocks;

  template <class Kernel>
  __global__ void __launch_bounds__(Kernel::n_threads, min_blocks<Kernel>)
    run_kernel(const Kernel kernel)
  {
    __shared__ typename Kernel::Scratch scratch[Kernel::n_scratch + (Kernel::n_scratch == 0)];
#  pragma unroll
    for (int phase = 0; phase < Kernel::n_phases; ++phase)
    {
      if (phase > 0)
        __syncthreads();
      kernel(phase, blockIdx.x, threadIdx.x, scratch);
    }
  }

  template <class Kernel>
  void Cuda::launch(const Kernel &kernel, const std::size_t n_blocks)
  {
    run_kernel<<<n_blocks, Kernel::n_threads, 0, cudaStreamPerThread>>>(kernel);
    check_cuda(cudaGetLastError());
  }
#endif
} // namespace softcell
