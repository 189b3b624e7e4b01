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

  Cuda::Recording::~Recording()
  {
    clear();
  }

  void Cuda::Recording::run(const std::function<void()> &work)
  {
    if (graph_ == nullptr)
    {
      cudaGraph_t graph    = nullptr;
      cudaGraphExec_t exec = nullptr;
      check_cuda(cudaStreamBeginCapture(cudaStreamPerThread, cudaStreamCaptureModeThreadLocal));
      try
      {
        work();
      }
      catch (...) // whatever it is, the stream must not stay in capture
      {
        if (cudaStreamEndCapture(cudaStreamPerThread, &graph) == cudaSuccess)
          cudaGraphDestroy(graph);
        cudaGetLastError(); // forgets that of the capture
        throw;
      }
      check_cuda(cudaStreamEndCapture(cudaStreamPerThread, &graph));
      check_cuda(cudaGraphInstantiate(&exec, graph, 0));
      check_cuda(cudaGraphDestroy(graph));
      graph_ = exec;
    }
    check_cuda(cudaGraphLaunch(static_cast<cudaGraphExec_t>(graph_), cudaStreamPerThread));
  }

  void Cuda::Recording::clear()
  {
    if (graph_ != nullptr)
      cudaGraphExecDestroy(static_cast<cudaGraphExec_t>(graph_)); // called from the destructor
    graph_ = nullptr;
  }
} // namespace softcell
