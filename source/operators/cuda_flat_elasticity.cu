// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card for flat patches.

#include "device_flat_elasticity.h"

namespace softcell
{
  template class CudaFlatElasticity<double, Cuda>;
  template class CudaFlatElasticity<float, Cuda>;
} // namespace softcell
