// SPDX-License-Identifier: LGPL-2.1-or-later
// The cells of a uniform grid in bricks.

#include <softcell/operators/cell_bricks.h>

#include <softcell/base/exceptions.h>
#include <softcell/operators/uniform_cells.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace softcell
{
  template <class Real>
  CellBricks<Real>::CellBricks(const CellLattice &cells)
      : n_entries(cells.nodes.size()),
        row(cells.nodes.row()),
        plane(cells.nodes.plane()),
        spacing{Real(cells.spacing[0]), Real(cells.spacing[1]), Real(cells.spacing[2])}
  {
    using Place = std::array<int, 3>; // in bricks
    if (!cells.point_cells.empty())
      throw BadInput("On a graphics card cells have their own Gauss points, and " +
                     std::to_string(cells.point_cells.size()) +
                     " of these have others; give 'Method = weighted cell'.");

    std::map<Place, std::vector<const GaussCell *>> bricks;
    for (const GaussCell &cell : cells.gauss_cells)
      bricks[{{cell.place[2] / size[2], cell.place[1] / size[1], cell.place[0] / size[0]}}]
        .push_back(&cell);

    const double full  = cells.spacing[0] * cells.spacing[1] * cells.spacing[2] / 8;
    const auto is_full = [&](const GaussCell *cell) {
      return std::all_of(cell->weights.begin(), cell->weights.end(),
                         [&](const double w) { return std::abs(w - full) < 1e-12 * full; });
    };
    const auto entry = [&](const Place &p) {
      return int(cells.nodes.entry(p[2] * size[0], p[1] * size[1], p[0] * size[2]));
    };
    std::map<Place, int> numbers;
    std::map<Place, NodeBrick> sums;
    for (const auto &[place, members] : bricks)
    {
      const int number = numbers[place] = entries.size();
      entries.push_back(entry(place));
      const bool all_full =
        members.size() == n_cells && std::all_of(members.begin(), members.end(), is_full);
      weight_packs.push_back(all_full ? -1 : int(weights.size() / (8 * n_cells)));
      if (!all_full)
      {
        const std::size_t start = weights.size();
        weights.resize(start + 8 * n_cells, Real(0));
        for (const GaussCell *cell : members)
        {
          const Place &p = cell->place;
          const int thread =
            p[0] % size[0] + size[0] * (p[1] % size[1] + size[1] * (p[2] % size[2]));
          for (int q = 0; q < 8; ++q)
            weights[start + q * n_cells + thread] = cell->weights[q];
        }
      }
      for (int side = 0; side < 8; ++side)
      {
        const Place p{{place[0] + (side >> 2), place[1] + (side >> 1 & 1), place[2] + (side & 1)}};
        const auto &n = cells.nodes.n_cells();
        if (p[2] * size[0] > n[0] || p[1] * size[1] > n[1] || p[0] * size[2] > n[2])
          continue;
        auto [sum, is_new] =
          sums.try_emplace(p, NodeBrick{entry(p),
                                        {std::min(size[1], n[1] + 1 - p[1] * size[1]),
                                         std::min(size[2], n[2] + 1 - p[0] * size[2])},
                                        {-1, -1, -1, -1, -1, -1, -1, -1}});
        sum->second.bricks[side] = number;
      }
    }
    for (const auto &[place, sum] : sums)
      node_bricks.push_back(sum);
  }

  template struct CellBricks<double>;
  template struct CellBricks<float>;
} // namespace softcell
