// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the supports hold a body against all six rigid-body motions.
#pragma once

#include <softcell/base/types.h>

#include <array>
#include <string>

namespace softcell
{
  /// The rigid-body motions that points held in some components leave free.
  ///
  /// A held component a of a point X contributes h h^T to a 6 x 6 Gram matrix, where h_k is
  /// component a at X of the translation (k < 3) or rotation along axis k. Its null space are the
  /// free motions.
  class RigidModes
  {
  public:
    /// @param body box around the body, to which lengths are related.
    explicit RigidModes(const Box &body);

    /// Displacement component `component` is prevented at X.
    void hold(const Point &X, unsigned int component);

    /// A sentence on what is free and what would mend it, for an error message; empty if nothing
    /// is free. Collective.
    std::string free_motions(MPI_Comm communicator) const;

  private:
    Point centre_;
    double length_;
    std::array<double, 36> gram_{};
  };
} // namespace softcell
