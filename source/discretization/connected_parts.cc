// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of a body that hang together.

#include <softcell/discretization/connected_parts.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace softcell
{
  std::vector<unsigned int> connected_parts(const Discretization &discretization)
  {
    // on this rank: trees of nodes, with the least number of a tree's nodes at its root
    const unsigned int n = discretization.node_positions().size();
    std::vector<unsigned int> parent(n), part(n);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](unsigned int node) {
      while (parent[node] != node)
        node = parent[node] = parent[parent[node]];
      return node;
    };
    for (unsigned int i = 0; i < discretization.n_patches(); ++i)
    {
      const std::vector<unsigned int> nodes = discretization.patch_nodes(i);
      for (const unsigned int node : nodes)
        parent[root(node)] = root(nodes[0]);
    }
    for (unsigned int node = 0; node < n; ++node)
      part[node] = discretization.partitioner()->local_to_global(3 * node) / 3;
    for (unsigned int node = 0; node < n; ++node)
      part[root(node)] = std::min(part[root(node)], part[node]);

    // between ranks: shared nodes take the least number, until nothing changes
    Vector numbers  = discretization.make_vector();
    bool has_change = true;
    while (dealii::Utilities::MPI::logical_or(has_change, discretization.communicator()))
    {
      numbers.zero_out_ghost_values();
      for (unsigned int node = 0; node < n; ++node)
        numbers.local_element(3 * node) = part[root(node)];
      numbers.compress(dealii::VectorOperation::min);
      numbers.update_ghost_values();
      has_change = false;
      for (unsigned int node = 0; node < n; ++node)
        if (const unsigned int number = numbers.local_element(3 * node); number < part[root(node)])
        {
          part[root(node)] = number;
          has_change       = true;
        }
    }
    for (unsigned int node = 0; node < n; ++node)
      part[node] = part[root(node)];
    return part;
  }
} // namespace softcell
