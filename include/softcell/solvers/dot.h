// SPDX-License-Identifier: LGPL-2.1-or-later
// The product of vectors whose values may not be finite.
#pragma once

#include <softcell/base/types.h>

#include <deal.II/base/mpi.h>

#include <numeric>

namespace softcell
{
  /// x . y; not finite where x or y is not, or where it overflows. deal.II's own products and norms
  /// are no way to ask for that: in Debug they stop the program. Collective.
  inline double dot(const Vector &x, const Vector &y)
  {
    const double here = std::transform_reduce(x.begin(), x.end(), y.begin(), 0.);
    return dealii::Utilities::MPI::sum(here, x.get_mpi_communicator());
  }
} // namespace softcell
