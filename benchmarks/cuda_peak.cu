// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of cuda_peak.h.

#include "cuda_peak.h"

#include <softcell/base/device_launch.h>

namespace softcell
{
  template void Cuda::launch(const FusedKernel<double> &, std::size_t);
  template void Cuda::launch(const FusedKernel<float> &, std::size_t);
} // namespace softcell
