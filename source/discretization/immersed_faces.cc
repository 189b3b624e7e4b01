// SPDX-License-Identifier: LGPL-2.1-or-later
// The faces over which the ghost penalty holds cut cells to their neighbours.
#include <softcell/discretization/immersed.h>

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace softcell
{
  namespace
  {
    /// A face of a cell of this rank with another cell, which is not smaller.
    struct Face
    {
      unsigned int cell, axis, rank; // that the neighbour belongs to
      Lattice::Cell neighbour;
    };

    /// Over all ranks each face once: the smaller cell has it, of equal ones the lower.
    std::vector<Face> find_faces(const BackgroundGrid &grid,
                                 const std::vector<BackgroundGrid::Cell> &cells)
    {
      std::vector<Face> faces;
      for (unsigned int i = 0; i < cells.size(); ++i)
      {
        const BackgroundGrid::Triangulation::active_cell_iterator cell(
          &grid.triangulation(), cells[i].level, cells[i].index);
        for (const unsigned int f : cell->face_indices())
          if (!cell->at_boundary(f) && !cell->neighbor(f)->has_children() &&
              (f % 2 == 1 || cell->neighbor_is_coarser(f)))
          {
            const auto neighbour = cell->neighbor(f);
            faces.push_back({i, f / 2, neighbour->subdomain_id(),
                             grid.place(neighbour->vertex(0), neighbour->level())});
          }
      }
      return faces;
    }

    /// What a rank tells of one of its cells.
    struct ToldCell
    {
      double cut_fraction = 0; // 0 if it is not active
      std::vector<dealii::types::global_dof_index> dofs;
      std::vector<double> condensation; // empty without hanging nodes

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &cut_fraction &dofs &condensation;
      }
    };
  } // namespace

  std::vector<Immersed::Neighbours>
  Immersed::find_neighbours(const BackgroundGrid &grid,
                            const std::vector<BackgroundGrid::Cell> &taken,
                            std::vector<dealii::types::global_dof_index> &cell_dofs)
  {
    MPI_Comm communicator         = grid.triangulation().get_communicator();
    const unsigned int rank       = dealii::Utilities::MPI::this_mpi_process(communicator);
    const std::vector<Face> faces = find_faces(grid, taken);

    std::map<unsigned int, std::vector<std::uint64_t>> questions; // by rank
    std::map<unsigned int, std::vector<Lattice::Cell>> asked;
    for (const Face &face : faces)
      if (face.rank != rank)
      {
        questions[face.rank].push_back(Lattice::key(face.neighbour));
        asked[face.rank].push_back(face.neighbour);
      }
    const auto tell = [&](const std::uint64_t key) {
      ToldCell told;
      const auto found = cell_of_.find(key);
      if (found == cell_of_.end())
        return told;
      const unsigned int i = found->second;
      const auto end       = i + 1 < cells_.size() ? cells_[i + 1].first_node : cell_dofs.size();
      told.cut_fraction    = cells_[i].cut_fraction;
      told.dofs.assign(cell_dofs.begin() + cells_[i].first_node, cell_dofs.begin() + end);
      if (cells_[i].has_hanging())
      {
        const auto begin = condensations_.begin() + cells_[i].hanging;
        told.condensation.assign(begin, begin + shapes_.n_nodes() * told.dofs.size());
      }
      return told;
    };
    std::map<unsigned int, std::vector<ToldCell>> answers;
    for (const auto &[other, keys] : dealii::Utilities::MPI::some_to_some(communicator, questions))
      for (const std::uint64_t key : keys)
        answers[other].push_back(tell(key));

    std::unordered_map<std::uint64_t, unsigned int> known = cell_of_;
    for (const auto &[other, told] : dealii::Utilities::MPI::some_to_some(communicator, answers))
      for (unsigned int k = 0; k < told.size(); ++k)
      {
        Cell cell;
        cell.place        = asked[other][k];
        cell.cut_fraction = told[k].cut_fraction;
        cell.first_node   = cell_dofs.size();
        if (cell.cut_fraction <= 0 ||
            !known.emplace(Lattice::key(cell.place), cells_.size()).second)
          continue;
        cell_dofs.insert(cell_dofs.end(), told[k].dofs.begin(), told[k].dofs.end());
        if (!told[k].condensation.empty())
          cell.hanging = condensations_.size();
        condensations_.insert(condensations_.end(), told[k].condensation.begin(),
                              told[k].condensation.end());
        cells_.push_back(cell);
      }

    std::vector<Neighbours> neighbours;
    for (const Face &face : faces)
      if (const auto second = known.find(Lattice::key(face.neighbour)); second != known.end())
        if (std::min(cells_[face.cell].cut_fraction, cells_[second->second].cut_fraction) <
            1 - 1e-9)
          neighbours.push_back({face.cell, second->second, face.axis});
    return neighbours;
  }

  GhostFace Immersed::make_ghost_face(const Neighbours &neighbours) const
  {
    const std::array<unsigned int, 2> cells = {{neighbours.first, neighbours.second}};
    std::array<Box, 2> boxes;
    GhostFace face;
    for (unsigned int k = 0; k < 2; ++k)
    {
      boxes[k] = lattice_.box(cells_[cells[k]].place);
      face.nodes.insert(face.nodes.end(), nodes(cells[k]).begin(), nodes(cells[k]).end());
    }
    std::sort(face.nodes.begin(), face.nodes.end());
    face.nodes.erase(std::unique(face.nodes.begin(), face.nodes.end()), face.nodes.end());
    face.label = body_.label(Point((boxes[0].center() + Direction(boxes[1].center())) / 2));

    const unsigned int n = face.nodes.size();
    face.products.assign(n * n, 0.);
    ShapeTable shapes;
    for (const Box &box : boxes)
    {
      const double h      = box.side_length(neighbours.axis);
      const double share  = std::pow(boxes[0].side_length(neighbours.axis) / h, 2); // of its face
      const double factor = ghost_penalty_ / (h * h) * share * box.volume();
      std::vector<double> jumps(gauss_points_.size() * n, 0.); // of the shapes (n_points, n)
      for (unsigned int k = 0; k < 2; ++k)
      {
        std::vector<Point> points;
        for (const Point &q : gauss_points_)
          points.push_back(boxes[k].real_to_unit(box.unit_to_real(q)));
        evaluate(cells[k], points, shapes);
        for (unsigned int i = 0; i < shapes.n_nodes; ++i)
        {
          const auto place =
            std::lower_bound(face.nodes.begin(), face.nodes.end(), nodes(cells[k])[i]);
          for (unsigned int q = 0; q < points.size(); ++q)
            jumps[q * n + (place - face.nodes.begin())] += (k == 0 ? 1 : -1) * shapes.value(q)[i];
        }
      }
      for (unsigned int q = 0; q < gauss_points_.size(); ++q)
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            face.products[i * n + j] +=
              factor * gauss_weights_[q] * jumps[q * n + i] * jumps[q * n + j];
    }
    return face;
  }
} // namespace softcell
