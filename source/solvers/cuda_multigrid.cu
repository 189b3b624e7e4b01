// SPDX-License-Identifier: LGPL-2.1-or-later
// Multigrid on a graphics card.

#include "device_multigrid.h"

namespace softcell
{
  template class CudaMultigrid<double, Cuda>;
  template class CudaMultigrid<float, Cuda>;
  template void CudaMultigrid<double, Cuda>::set_state(const DeviceArray<double, Cuda> &, Tangent);
  template void CudaMultigrid<double, Cuda>::vmult(DeviceArray<double, Cuda> &,
                                                   const DeviceArray<double, Cuda> &);
  template void CudaMultigrid<float, Cuda>::set_state(const DeviceArray<double, Cuda> &, Tangent);
  template void CudaMultigrid<float, Cuda>::vmult(DeviceArray<double, Cuda> &,
                                                  const DeviceArray<double, Cuda> &);
  template void CudaMultigrid<float, Cuda>::set_state(const DeviceArray<float, Cuda> &, Tangent);
  template void CudaMultigrid<float, Cuda>::vmult(DeviceArray<float, Cuda> &,
                                                  const DeviceArray<float, Cuda> &);
} // namespace softcell
