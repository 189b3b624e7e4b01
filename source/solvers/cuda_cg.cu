// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients on a graphics card.

#include "device_cg.h"

namespace softcell
{
  template class CudaCG<double, Cuda>;
  template class CudaCG<float, Cuda>;
} // namespace softcell
