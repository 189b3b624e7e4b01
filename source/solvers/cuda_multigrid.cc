// SPDX-License-Identifier: LGPL-2.1-or-later
// Multigrid of the graphics card, on the host.

#include "device_multigrid.h"

namespace softcell
{
  template class CudaMultigrid<double, Serial>;
  template class CudaMultigrid<float, Serial>;
  template void CudaMultigrid<double, Serial>::set_state(const DeviceArray<double, Serial> &,
                                                         Tangent);
  template void CudaMultigrid<double, Serial>::vmult(DeviceArray<double, Serial> &,
                                                     const DeviceArray<double, Serial> &);
  template void CudaMultigrid<float, Serial>::set_state(const DeviceArray<double, Serial> &,
                                                        Tangent);
  template void CudaMultigrid<float, Serial>::vmult(DeviceArray<double, Serial> &,
                                                    const DeviceArray<double, Serial> &);
  template void CudaMultigrid<float, Serial>::set_state(const DeviceArray<float, Serial> &,
                                                        Tangent);
  template void CudaMultigrid<float, Serial>::vmult(DeviceArray<float, Serial> &,
                                                    const DeviceArray<float, Serial> &);
} // namespace softcell
