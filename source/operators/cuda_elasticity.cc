// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernels of the graphics card on the host.

#include "device_elasticity.h"

namespace softcell
{
  template class CudaElasticity<double, Serial>;
  template class CudaElasticity<float, Serial>;
} // namespace softcell
