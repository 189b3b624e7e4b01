// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the supports hold a body against all six rigid-body motions.
#pragma once

#include <softcell/base/types.h>
#include <softcell/discretization/discretization.h>

#include <array>
#include <map>
#include <string>
#include <vector>

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
    /// @param what  is held, such as "the body".
    std::string free_motions(MPI_Comm communicator, const std::string &what) const;

  private:
    Point centre_;
    double length_;
    std::array<double, 36> gram_{};
  };

  /// The same of each part of a body that moves without the others.
  class HeldParts
  {
  public:
    /// @param body box around the body. Collective.
    HeldParts(const Discretization &discretization, const Box &body);

    /// Displacement component `component` is prevented at X, in a patch of this local node.
    void hold(unsigned int node, const Point &X, unsigned int component);

    /// The sentence on the first part that is not held; empty if all are. Collective.
    std::string free_motions() const;

  private:
    std::string name_of(unsigned int part, std::size_t n_parts) const;

    const Discretization &discretization_;
    const Box body_;
    const std::vector<unsigned int> parts_;   // of the nodes
    std::map<unsigned int, RigidModes> held_; // by part
  };
} // namespace softcell
