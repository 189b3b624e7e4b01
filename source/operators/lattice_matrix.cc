// SPDX-License-Identifier: LGPL-2.1-or-later
// Products and Galerkin's coarse matrices.

#include <softcell/operators/lattice_matrix.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <unordered_map>

namespace softcell
{
  namespace
  {
    std::array<int, 3> place(const NodeLattice &nodes, const std::size_t node)
    {
      return {{int(node % nodes.plane() % nodes.row()), int(node % nodes.plane() / nodes.row()),
               int(node / nodes.plane())}};
    }

    /// Number of the neighbour from `from` to `to` in a stencil, along x first.
    unsigned int neighbour(const std::array<int, 3> &from, const std::array<int, 3> &to)
    {
      unsigned int number = 0;
      for (int d = 2; d >= 0; --d)
      {
        const int step = to[d] - from[d];
        Assert(step >= -1 && step <= 1, dealii::ExcMessage("Not of a common cell."));
        number = 3 * number + (step + 1);
      }
      return number;
    }

    /// The coarse nodes whose trilinear functions have a value at a node.
    struct Parents
    {
      explicit Parents(const std::array<int, 3> &child)
      {
        for (unsigned int d = 0; d < dim; ++d)
          n[d] = 1 + child[d] % 2;
        for (int v = 0; v < n[0] * n[1] * n[2]; ++v)
          places.push_back({{child[0] / 2 + v % n[0], child[1] / 2 + v / n[0] % n[1],
                             child[2] / 2 + v / (n[0] * n[1])}});
      }

      int n[3];
      std::vector<std::array<int, 3>> places;
      double value() const // of each function
      {
        return 1. / places.size();
      }
    };
  } // namespace

  template <class Real>
  LatticeMatrix<Real>::LatticeMatrix(const BlockMatrix &matrix,
                                     const std::vector<std::size_t> &entries,
                                     const NodeLattice &nodes)
  {
    for (unsigned int row = 0; row < entries.size(); ++row)
    {
      const std::size_t begin = matrix.row_start()[row], n = matrix.row_start()[row + 1] - begin;
      const double *const values = matrix.values().data() + 9 * begin;
      if (std::all_of(values, values + 9 * n, [](const double value) { return value == 0; }))
        continue;
      Stencil stencil{};
      for (unsigned int block = 0; block < n; ++block)
      {
        const std::size_t column = entries[matrix.columns()[begin + block]];
        auto &sum = stencil[neighbour(place(nodes, entries[row]), place(nodes, column))];
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            sum[3 * a + b] = values[(a * n + block) * 3 + b];
      }
      append(entries[row], stencil, nodes);
    }
  }

  template <class Real>
  LatticeMatrix<Real>::LatticeMatrix(const LatticeMatrix &fine,
                                     const LatticeUnknowns &fine_unknowns,
                                     const NodeLattice &nodes)
  {
    std::unordered_map<std::size_t, std::size_t> rows; // of coarse nodes
    std::vector<Stencil> stencils;
    for (std::size_t row = 0, block = 0; row < fine.nodes_.size(); ++row)
    {
      const Parents parents(place(fine_unknowns.nodes(), fine.nodes_[row]));
      for (; block < fine.row_ends_[row]; ++block)
      {
        const Parents others(place(fine_unknowns.nodes(), fine.columns_[block]));
        std::array<double, 9> share;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
          {
            const bool is_free = fine_unknowns.is_free(fine.nodes_[row], a) &&
                                 fine_unknowns.is_free(fine.columns_[block], b);
            share[3 * a + b] =
              is_free ? parents.value() * others.value() * fine.blocks_[block][3 * a + b] : 0;
          }
        for (const auto &parent : parents.places)
        {
          const auto [found, is_new] =
            rows.try_emplace(nodes.entry(parent[0], parent[1], parent[2]), stencils.size());
          if (is_new)
            stencils.push_back({});
          for (const auto &other : others.places)
          {
            auto &sum = stencils[found->second][neighbour(parent, other)];
            for (unsigned int k = 0; k < 9; ++k)
              sum[k] += share[k];
          }
        }
      }
    }
    std::vector<std::pair<std::size_t, std::size_t>> sorted(rows.begin(), rows.end());
    std::sort(sorted.begin(), sorted.end());
    for (const auto &[node, row] : sorted)
      append(node, stencils[row], nodes);
  }

  template <class Real>
  template <class OtherReal>
  LatticeMatrix<Real>::LatticeMatrix(const LatticeMatrix<OtherReal> &other)
      : nodes_(other.nodes_), row_ends_(other.row_ends_), columns_(other.columns_)
  {
    for (const auto &block : other.blocks_)
    {
      blocks_.emplace_back();
      std::copy(block.begin(), block.end(), blocks_.back().begin());
    }
  }

  template <class Real>
  void LatticeMatrix<Real>::append(const std::size_t node,
                                   const Stencil &stencil,
                                   const NodeLattice &nodes)
  {
    nodes_.push_back(node);
    const auto [i, j, k] = place(nodes, node);
    for (int v = 0; v < 27; ++v)
    {
      if (std::all_of(stencil[v].begin(), stencil[v].end(), [](const double x) { return x == 0; }))
        continue;
      columns_.push_back(nodes.entry(i + v % 3 - 1, j + v / 3 % 3 - 1, k + v / 9 - 1));
      blocks_.emplace_back();
      std::copy(stencil[v].begin(), stencil[v].end(), blocks_.back().begin());
    }
    row_ends_.push_back(columns_.size());
  }

  template <class Real>
  void LatticeMatrix<Real>::add_product(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
#pragma omp parallel for schedule(static)
    for (std::size_t row = 0; row < nodes_.size(); ++row)
    {
      Real sum[3] = {0, 0, 0};
      for (std::size_t block = row > 0 ? row_ends_[row - 1] : 0; block < row_ends_[row]; ++block)
        for (unsigned int b = 0; b < dim; ++b)
        {
          const Real value = x.component(b)[columns_[block]];
          for (unsigned int a = 0; a < dim; ++a)
            sum[a] += blocks_[block][3 * a + b] * value;
        }
      for (unsigned int a = 0; a < dim; ++a)
        y.component(a)[nodes_[row]] += sum[a];
    }
  }

  template <class Real>
  void LatticeMatrix<Real>::add_diagonal(LatticeBlocks<Real> &blocks) const
  {
    for (std::size_t row = 0, block = 0; row < nodes_.size(); ++row)
      for (; block < row_ends_[row]; ++block)
        if (columns_[block] == nodes_[row])
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a; b < dim; ++b)
              blocks.component(a == b ? a : 6 - a - b)[nodes_[row]] +=
                (blocks_[block][3 * a + b] + blocks_[block][3 * b + a]) / 2;
  }

  template <class Real>
  std::size_t LatticeMatrix<Real>::memory() const
  {
    return blocks_.capacity() * (sizeof(Block) + sizeof(std::size_t)) +
           nodes_.capacity() * 2 * sizeof(std::size_t);
  }

  template class LatticeMatrix<double>;
  template class LatticeMatrix<float>;
  template LatticeMatrix<float>::LatticeMatrix(const LatticeMatrix<double> &);
} // namespace softcell
