// SPDX-License-Identifier: LGPL-2.1-or-later
// Conjugate gradients of the graphics card, on the host.

#include "device_cg.h"

namespace softcell
{
  template class CudaCG<double, Serial>;
  template class CudaCG<float, Serial>;
  template class InverseDiagonal<double, Serial>;
  template class InverseDiagonal<float, Serial>;
} // namespace softcell
