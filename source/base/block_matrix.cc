// SPDX-License-Identifier: LGPL-2.1-or-later
// Pattern, assembly, exchange and product of the block matrix.

#include <softcell/base/block_matrix.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <map>
#include <utility>

namespace softcell
{
  namespace
  {
    /// Values of consecutive block rows that travel between two ranks in compress().
    struct RowMessage
    {
      unsigned int rank;
      std::size_t begin = 0, end = 0; // of the doubles: in values (sent), in the buffer (received)
      std::vector<unsigned int> rows; // received: owned rows
      std::vector<unsigned int> lengths; // received: blocks in each of them
      std::vector<unsigned int>
        positions; // received: where they lie in their row, one after the other
    };
  } // namespace

  struct BlockMatrix::Data
  {
    std::shared_ptr<const Partitioner> unknowns;
    std::shared_ptr<const Partitioner> column_unknowns; // the ghosts are all columns of owned rows
    unsigned int n_owned = 0;

    std::vector<std::size_t> row_start;      // (local nodes + 1), owned rows and then ghost rows
    std::vector<unsigned int> columns;       // (n_blocks) global nodes, ascending in each row
    std::vector<unsigned int> local_columns; // (n_blocks) the same as nodes of column_unknowns
    std::vector<double> values;              // (n_blocks * 9)

    std::vector<unsigned int>
      column_of_node; // (local nodes) the node among those of column_unknowns
    std::vector<unsigned int>
      position; // (nodes of column_unknowns) scratch: position in the current row
    std::vector<unsigned int> offsets; // (nodes of a patch) scratch

    std::vector<RowMessage> sent, received;
    std::vector<double> buffer;
    mutable Vector x; // with ghost values for all columns

    unsigned int global_node(const unsigned int node) const
    {
      return unknowns->local_to_global(3 * node) / 3;
    }

    std::vector<std::vector<unsigned int>>
    local_pattern(const std::vector<std::vector<unsigned int>> &couplings) const;
    void exchange_pattern(std::vector<std::vector<unsigned int>> &pattern);
    void number_columns();
  };

  /// For each local node the global nodes that it is coupled with (itself at least), ascending.
  std::vector<std::vector<unsigned int>>
  BlockMatrix::Data::local_pattern(const std::vector<std::vector<unsigned int>> &couplings) const
  {
    const unsigned int n_nodes = (unknowns->locally_owned_size() + unknowns->n_ghost_indices()) / 3;

    std::vector<std::vector<unsigned int>> lists_of_node(n_nodes);
    for (unsigned int l = 0; l < couplings.size(); ++l)
      for (const unsigned int node : couplings[l])
        lists_of_node[node].push_back(l);

    std::vector<std::vector<unsigned int>> pattern(n_nodes);
    std::vector<unsigned int> last_row(n_nodes, dealii::numbers::invalid_unsigned_int);
    for (unsigned int row = 0; row < n_nodes; ++row)
    {
      std::vector<unsigned int> &coupled = pattern[row];
      const auto insert                  = [&](const unsigned int node) {
        if (last_row[node] != row)
          coupled.push_back(global_node(node));
        last_row[node] = row;
      };
      insert(row);
      for (const unsigned int l : lists_of_node[row])
        std::for_each(couplings[l].begin(), couplings[l].end(), insert);
      std::sort(coupled.begin(), coupled.end());
      lists_of_node[row] = {};
    }
    return pattern;
  }

  /// Merges the ghost rows of other ranks into the owned rows, stores the rows and prepares
  /// compress().
  void BlockMatrix::Data::exchange_pattern(std::vector<std::vector<unsigned int>> &pattern)
  {
    // A message is row, length, columns, row, ...; the ghost rows of one owner lie together.
    std::map<unsigned int, std::vector<unsigned int>> messages;
    unsigned int row = n_owned;
    for (const auto &[rank, n_unknowns] : unknowns->ghost_targets())
      for (const unsigned int end = row + n_unknowns / 3; row < end; ++row)
      {
        std::vector<unsigned int> &message = messages[rank];
        message.push_back(global_node(row));
        message.push_back(pattern[row].size());
        message.insert(message.end(), pattern[row].begin(), pattern[row].end());
      }
    const auto incoming =
      dealii::Utilities::MPI::some_to_some(unknowns->get_mpi_communicator(), messages);

    const unsigned int first_node = unknowns->local_range().first / 3;
    for (const auto &[rank, message] : incoming)
      for (auto word = message.begin(); word != message.end(); word += 2 + word[1])
      {
        std::vector<unsigned int> &own = pattern[word[0] - first_node], merged;
        std::set_union(own.begin(), own.end(), word + 2, word + 2 + word[1],
                       std::back_inserter(merged));
        own.swap(merged);
      }

    row_start.assign(1, 0);
    for (const std::vector<unsigned int> &row_columns : pattern)
    {
      columns.insert(columns.end(), row_columns.begin(), row_columns.end());
      row_start.push_back(columns.size());
    }
    values.assign(9 * columns.size(), 0.);

    row = n_owned;
    for (const auto &[rank, n_unknowns] : unknowns->ghost_targets())
    {
      sent.push_back({rank, 9 * row_start[row], 9 * row_start[row + n_unknowns / 3], {}, {}, {}});
      row += n_unknowns / 3;
    }
    for (const auto &[rank, message] : incoming)
    {
      RowMessage expected{rank, buffer.size(), 0, {}, {}, {}};
      for (auto word = message.begin(); word != message.end(); word += 2 + word[1])
      {
        const std::vector<unsigned int> &row_columns = pattern[word[0] - first_node];
        expected.rows.push_back(word[0] - first_node);
        expected.lengths.push_back(word[1]);
        auto column = row_columns.begin();
        for (unsigned int k = 0; k < word[1]; ++k)
        {
          column = std::lower_bound(column, row_columns.end(), word[2 + k]);
          expected.positions.push_back(column - row_columns.begin());
        }
      }
      buffer.resize(buffer.size() + 9 * expected.positions.size());
      expected.end = buffer.size();
      received.push_back(std::move(expected));
    }
  }

  void BlockMatrix::Data::number_columns()
  {
    dealii::IndexSet ghosts = unknowns->ghost_indices();
    std::vector<dealii::types::global_dof_index> more;
    for (std::size_t k = 0; k < row_start[n_owned]; ++k)
      if (!unknowns->in_local_range(3 * columns[k]))
        for (unsigned int c = 0; c < 3; ++c)
          more.push_back(3 * columns[k] + c);
    std::sort(more.begin(), more.end());
    ghosts.add_indices(more.begin(), std::unique(more.begin(), more.end()));
    column_unknowns = std::make_shared<Partitioner>(unknowns->locally_owned_range(), ghosts,
                                                    unknowns->get_mpi_communicator());
    x.reinit(column_unknowns);

    local_columns.resize(columns.size());
    std::transform(
      columns.begin(), columns.end(), local_columns.begin(),
      [&](const unsigned int node) { return column_unknowns->global_to_local(3 * node) / 3; });
    column_of_node.resize(row_start.size() - 1);
    for (unsigned int node = 0; node < column_of_node.size(); ++node)
      column_of_node[node] = column_unknowns->global_to_local(3 * global_node(node)) / 3;
    position.resize(n_owned + ghosts.n_elements() / 3);
  }

  BlockMatrix::BlockMatrix(const std::shared_ptr<const Partitioner> &unknowns,
                           const std::vector<std::vector<unsigned int>> &couplings)
      : data_(std::make_unique<Data>())
  {
    data_->unknowns = unknowns;
    data_->n_owned  = unknowns->locally_owned_size() / 3;
    auto pattern    = data_->local_pattern(couplings);
    data_->exchange_pattern(pattern);
    data_->number_columns();
  }

  BlockMatrix::~BlockMatrix()                       = default;
  BlockMatrix::BlockMatrix(BlockMatrix &&) noexcept = default;

  void BlockMatrix::set_zero()
  {
    std::fill(data_->values.begin(), data_->values.end(), 0.);
  }

  void BlockMatrix::add(const View<const unsigned int> nodes, const double *const patch_values)
  {
    Data &d              = *data_;
    const unsigned int n = nodes.size();
    d.offsets.resize(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      // Noting the place of every column of the row is faster than searching for those of the
      // patch.
      const std::size_t begin           = d.row_start[nodes[i]];
      const unsigned int length         = d.row_start[nodes[i] + 1] - begin;
      const unsigned int *const columns = d.local_columns.data() + begin;
      for (unsigned int k = 0; k < length; ++k)
        d.position[columns[k]] = k;
      for (unsigned int j = 0; j < n; ++j)
      {
        const unsigned int column = d.column_of_node[nodes[j]];
        Assert(d.position[column] < length && columns[d.position[column]] == column,
               dealii::ExcMessage("These nodes do not couple."));
        d.offsets[j] = 3 * d.position[column];
      }
      for (unsigned int a = 0; a < 3; ++a)
      {
        double *const row          = d.values.data() + 9 * begin + a * 3 * length;
        const double *const source = patch_values + (a * n + i) * 3 * n;
        for (unsigned int j = 0; j < n; ++j)
          for (unsigned int b = 0; b < 3; ++b)
            row[d.offsets[j] + b] += source[b * n + j];
      }
    }
  }

  void BlockMatrix::compress()
  {
    Data &d                     = *data_;
    constexpr int tag           = 231;
    const MPI_Comm communicator = d.unknowns->get_mpi_communicator();
    std::vector<MPI_Request> requests;
    for (const RowMessage &message : d.received)
      MPI_Irecv(d.buffer.data() + message.begin, message.end - message.begin, MPI_DOUBLE,
                message.rank, tag, communicator, &requests.emplace_back());
    for (const RowMessage &message : d.sent)
      MPI_Isend(d.values.data() + message.begin, message.end - message.begin, MPI_DOUBLE,
                message.rank, tag, communicator, &requests.emplace_back());
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);

    // The order of ranks, not of arrival, so that the sums are the same in every run.
    for (const RowMessage &message : d.received)
    {
      const double *source         = d.buffer.data() + message.begin;
      const unsigned int *position = message.positions.data();
      for (unsigned int r = 0; r < message.rows.size(); ++r)
      {
        const std::size_t begin   = d.row_start[message.rows[r]];
        const unsigned int length = d.row_start[message.rows[r] + 1] - begin;
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int k = 0; k < message.lengths[r]; ++k)
            for (unsigned int b = 0; b < 3; ++b)
              d.values[9 * begin + (a * length + position[k]) * 3 + b] += *source++;
        position += message.lengths[r];
      }
    }
    std::fill(d.values.begin() + 9 * d.row_start[d.n_owned], d.values.end(), 0.);
  }

  void BlockMatrix::constrain(const std::vector<unsigned int> &local_unknowns,
                              const double diagonal)
  {
    Data &d = *data_;
    Vector marks(d.column_unknowns);
    for (const unsigned int unknown : local_unknowns)
      marks.local_element(3 * d.column_of_node[unknown / 3] + unknown % 3) = 1.;
    marks.compress(dealii::VectorOperation::add);
    marks.update_ghost_values();
    const double *const mark = marks.begin();

    for (unsigned int row = 0; row < d.n_owned; ++row)
    {
      const std::size_t begin   = d.row_start[row];
      const unsigned int length = d.row_start[row + 1] - begin;
      for (unsigned int k = 0; k < length; ++k)
      {
        const unsigned int column = d.local_columns[begin + k];
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b < 3; ++b)
            if (mark[3 * row + a] > 0. || mark[3 * column + b] > 0.)
              d.values[9 * begin + (a * length + k) * 3 + b] =
                row == column && a == b ? diagonal : 0.;
      }
    }
  }

  void BlockMatrix::vmult(Vector &y, const Vector &x) const
  {
    const Data &d = *data_;
    std::copy_n(x.begin(), 3 * d.n_owned, d.x.begin());
    d.x.update_ghost_values();
    const double *const all_x = d.x.begin();
    for (unsigned int row = 0; row < d.n_owned; ++row)
    {
      const std::size_t begin           = d.row_start[row];
      const unsigned int length         = d.row_start[row + 1] - begin;
      const unsigned int *const columns = d.local_columns.data() + begin;
      const double *const row_0         = d.values.data() + 9 * begin;
      const double *const row_1         = row_0 + 3 * length;
      const double *const row_2         = row_1 + 3 * length;
      double sum_0 = 0, sum_1 = 0, sum_2 = 0;
      for (unsigned int k = 0; k < length; ++k)
        for (unsigned int b = 0; b < 3; ++b)
        {
          const double value = all_x[3 * columns[k] + b];
          sum_0 += row_0[3 * k + b] * value;
          sum_1 += row_1[3 * k + b] * value;
          sum_2 += row_2[3 * k + b] * value;
        }
      y.local_element(3 * row)     = sum_0;
      y.local_element(3 * row + 1) = sum_1;
      y.local_element(3 * row + 2) = sum_2;
    }
  }

  Vector BlockMatrix::diagonal() const
  {
    const Data &d                = *data_;
    const unsigned int first_row = d.unknowns->local_range().first / 3;
    Vector result(d.unknowns);
    for (unsigned int row = 0; row < d.n_owned; ++row)
    {
      const std::size_t begin  = d.row_start[row];
      const std::size_t length = d.row_start[row + 1] - begin;
      const auto columns       = d.columns.begin() + begin;
      const std::size_t block =
        std::lower_bound(columns, columns + length, first_row + row) - columns;
      for (unsigned int c = 0; c < 3; ++c)
        result.local_element(3 * row + c) = d.values[9 * begin + (c * length + block) * 3 + c];
    }
    return result;
  }

  const std::vector<std::size_t> &BlockMatrix::row_start() const
  {
    return data_->row_start;
  }

  const std::vector<unsigned int> &BlockMatrix::columns() const
  {
    return data_->columns;
  }

  const std::vector<double> &BlockMatrix::values() const
  {
    return data_->values;
  }

  const std::shared_ptr<const Partitioner> &BlockMatrix::partitioner() const
  {
    return data_->unknowns;
  }
} // namespace softcell
