// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement of a run as an HDF5 file, to go on from or to read elsewhere.

#include <softcell/output/checkpoint.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <hdf5.h>
#include <map>
#include <vector>

namespace softcell
{
  namespace
  {
    constexpr double largest_rounds = 8; // that `Refinement steps` allow

    /// Positions and displacements of all nodes, three numbers each; rounds and points of
    /// refinement, four numbers each.
    struct Content
    {
      std::vector<double> positions, displacement, refinement;
      double load_factor = 0;
      bool is_good       = false; // it could be read

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &positions &displacement &refinement &load_factor &is_good;
      }
    };

    bool write_data(const hid_t file,
                    const char *name,
                    const std::vector<hsize_t> &size,
                    const double *values)
    {
      const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
      const hid_t data =
        H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      const bool is_good =
        data >= 0 && H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
      H5Dclose(data);
      H5Sclose(space);
      return is_good;
    }

    bool read_data(const hid_t file, const char *name, std::vector<double> &values)
    {
      const hid_t data  = H5Dopen2(file, name, H5P_DEFAULT);
      const hid_t space = H5Dget_space(data);
      values.resize(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
      const bool is_good = data >= 0 && H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                                H5P_DEFAULT, values.data()) >= 0;
      H5Sclose(space);
      H5Dclose(data);
      return is_good;
    }

    bool write_content(const std::string &name, const Content &content)
    {
      const std::string part = name + ".part"; // a run may be killed while it writes
      bool is_good           = false;
      H5E_BEGIN_TRY // its own messages are for programmers
      {
        const hid_t file = H5Fcreate(part.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        const hsize_t n  = content.positions.size() / 3;
        is_good = file >= 0 && write_data(file, "positions", {n, 3}, content.positions.data()) &&
                  write_data(file, "displacement", {n, 3}, content.displacement.data()) &&
                  write_data(file, "load_factor", {1}, &content.load_factor) &&
                  (content.refinement.empty() ||
                   write_data(file, "refinement", {content.refinement.size() / 4, 4},
                              content.refinement.data()));
        is_good = H5Fclose(file) >= 0 && is_good;
      }
      H5E_END_TRY
      if (is_good && std::rename(part.c_str(), name.c_str()) == 0)
        return true;
      std::remove(part.c_str());
      return false;
    }

    /// Are these rows of a whole round and a point?
    bool is_in_rows(const std::vector<double> &refinement)
    {
      bool is_good = refinement.size() % 4 == 0;
      for (std::size_t i = 0; is_good && i < refinement.size(); i += 4)
        is_good = refinement[i] >= 0 && refinement[i] < largest_rounds &&
                  refinement[i] == std::floor(refinement[i]);
      return is_good;
    }

    Content read_content(const std::string &name)
    {
      Content content;
      std::vector<double> load_factor;
      H5E_BEGIN_TRY
      {
        const hid_t file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
        content.is_good =
          file >= 0 && read_data(file, "positions", content.positions) &&
          read_data(file, "displacement", content.displacement) &&
          read_data(file, "load_factor", load_factor) && load_factor.size() == 1 &&
          content.positions.size() == content.displacement.size() &&
          (H5Lexists(file, "refinement", H5P_DEFAULT) <= 0 ||
           (read_data(file, "refinement", content.refinement) && is_in_rows(content.refinement)));
        H5Fclose(file);
      }
      H5E_END_TRY
      if (content.is_good)
        content.load_factor = load_factor[0];
      const auto is_finite = [](const std::vector<double> &values) {
        return std::all_of(values.begin(), values.end(),
                           [](const double value) { return std::isfinite(value); });
      };
      content.is_good = content.is_good && is_finite(content.positions) &&
                        is_finite(content.displacement) && is_finite(load_factor) &&
                        is_finite(content.refinement);
      return content;
    }

    /// @throws BadInput
    Content read_on_root(const std::string &file, MPI_Comm communicator)
    {
      namespace mpi = dealii::Utilities::MPI;
      Content content;
      if (mpi::this_mpi_process(communicator) == 0)
        content = read_content(file);
      content = mpi::broadcast(communicator, content);
      if (!content.is_good)
      {
        check_file("Solver/Start from = " + file, file);
        throw BadInput("The checkpoint '" + file +
                       "' cannot be read; give a whole one that softcell wrote.");
      }
      return content;
    }

    std::vector<double> in_rows(const Refinement &refinement)
    {
      std::vector<double> rows;
      for (unsigned int round = 0; round < refinement.size(); ++round)
        for (const Point &X : refinement[round])
          rows.insert(rows.end(), {double(round), X[0], X[1], X[2]});
      return rows;
    }

    /// Nodes by their position in steps of a length far below any cell and far above round-off.
    class NodesByPosition
    {
    public:
      explicit NodesByPosition(const std::vector<double> &positions)
      {
        double largest = 0;
        for (const double x : positions)
          largest = std::max(largest, std::abs(x));
        step_ = largest > 0 ? 1e-7 * largest : 1;
        for (unsigned int i = 0; i < positions.size() / 3; ++i)
        {
          Key key;
          for (unsigned int d = 0; d < 3; ++d)
            key[d] = std::llround(positions[3 * i + d] / step_);
          nodes_[key] = i;
        }
      }

      /// Number of the node at X, or -1.
      int node(const Point &X) const
      {
        for (unsigned int corner = 0; corner < 8; ++corner) // round-off may have crossed a step
        {
          Key key;
          for (unsigned int d = 0; d < 3; ++d)
            key[d] = static_cast<long long>(std::floor(X[d] / step_)) + ((corner >> d) & 1);
          if (const auto found = nodes_.find(key); found != nodes_.end())
            return static_cast<int>(found->second);
        }
        return -1;
      }

    private:
      using Key = std::array<long long, 3>;

      double step_;
      std::map<Key, unsigned int> nodes_;
    };

    std::vector<double> joined(const std::vector<std::vector<double>> &parts)
    {
      std::vector<double> all;
      for (const std::vector<double> &part : parts)
        all.insert(all.end(), part.begin(), part.end());
      return all;
    }
  } // namespace

  void write_checkpoint(const std::string &file,
                        const Discretization &discretization,
                        const Vector &u,
                        const double load_factor,
                        const Refinement &refinement)
  {
    namespace mpi            = dealii::Utilities::MPI;
    const std::size_t n_mine = 3 * discretization.n_owned_nodes();
    std::vector<double> positions(n_mine), displacement(n_mine);
    for (std::size_t i = 0; i < n_mine; ++i)
    {
      positions[i]    = discretization.node_positions()[i / 3][i % 3];
      displacement[i] = u.local_element(i);
    }
    const MPI_Comm communicator = discretization.communicator();
    const auto all_positions    = mpi::gather(communicator, positions, 0);
    const auto all_displacement = mpi::gather(communicator, displacement, 0);

    bool is_good = true;
    if (mpi::this_mpi_process(communicator) == 0)
      is_good = write_content(file, {joined(all_positions), joined(all_displacement),
                                     in_rows(refinement), load_factor, true});
    if (mpi::min(is_good ? 1 : 0, communicator) == 0)
      throw BadInput(
        "The checkpoint '" + file +
        "' cannot be written; give a folder with room and permission by --output DIR.");
  }

  Refinement read_refinement(const std::string &file, MPI_Comm communicator)
  {
    Refinement refinement;
    const std::vector<double> rows = read_on_root(file, communicator).refinement;
    for (std::size_t i = 0; i < rows.size(); i += 4)
    {
      refinement.resize(std::max<std::size_t>(refinement.size(), std::size_t(rows[i]) + 1));
      refinement[std::size_t(rows[i])].emplace_back(rows[i + 1], rows[i + 2], rows[i + 3]);
    }
    return refinement;
  }

  double read_checkpoint(const std::string &file, const Discretization &discretization, Vector &u)
  {
    namespace mpi               = dealii::Utilities::MPI;
    const MPI_Comm communicator = discretization.communicator();
    const Content content       = read_on_root(file, communicator);
    const NodesByPosition nodes(content.positions);
    int n_missing = 0;
    for (unsigned int i = 0; i < discretization.n_owned_nodes(); ++i)
    {
      const int node = nodes.node(discretization.node_positions()[i]);
      n_missing += node < 0 ? 1 : 0;
      for (unsigned int d = 0; d < 3; ++d)
        u.local_element(3 * i + d) = node < 0 ? 0 : content.displacement[3 * node + d];
    }
    n_missing = mpi::sum(n_missing, communicator);
    if (n_missing > 0)
      throw BadInput("The checkpoint '" + file + "' lacks " + std::to_string(n_missing) +
                     " of the " + std::to_string(discretization.partitioner()->size() / 3) +
                     " nodes; start from one of the same grid or mesh.");
    u.update_ghost_values();
    return content.load_factor;
  }
} // namespace softcell
