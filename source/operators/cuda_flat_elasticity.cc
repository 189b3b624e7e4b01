// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card for flat patches on the host.

#include "device_flat_elasticity.h"

namespace softcell
{
  template class CudaFlatElasticity<double, Serial>;
  template class CudaFlatElasticity<float, Serial>;
} // namespace softcell
