// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card.

#include "device_elasticity.h"

namespace softcell
{
  template class CudaElasticity<double, Cuda>;
  template class CudaElasticity<float, Cuda>;
} // namespace softcell
