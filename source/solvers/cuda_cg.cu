// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients on a graphics card.

#include "device_cg.h"

namespace softcell
{
  template class CudaCG<double, Cuda>;
  template class CudaCG<float, Cuda>;
  template class InverseDiagonal<double, Cuda>;
  template class InverseDiagonal<float, Cuda>;
} // namespace softcell
