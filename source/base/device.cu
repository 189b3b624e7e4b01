// SPDX-License-Identifier: LGPL-2.1-or-later
// Memory of a graphics card.

#include <softcell/base/device_launch.h>

namespace softcell
{
  bool Cuda::is_there()
  {
    int n_devices = 0;
    return cudaGetDeviceCount(&n_devices) == cudaSuccess && n_devices > 0;
  }

  void *Cuda::allocate(const std::size_t n_bytes)
  {
    void *memory = nullptr;
    check_cuda(cudaMalloc(&memory, n_bytes + 1));
    check_cuda(cudaMemset(memory, 0, n_bytes));
    return memory;
  }

  void Cuda::release(void *const memory)
  {
    cudaFree(memory); // called from destructors, which must not throw
  }

  void Cuda::copy(void *const to, const void *const from, const std::size_t n_bytes)
  {
    check_cuda(cudaMemcpy(to, from, n_bytes, cudaMemcpyDefault));
  }
} // namespace softcell
