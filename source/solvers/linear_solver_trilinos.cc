// SPDX-License-Identifier: LGPL-2.1-or-later
// Incomplete Cholesky by Ifpack and smoothed aggregation by ML, through Trilinos.

#include <softcell/base/exceptions.h>
#include <softcell/solvers/approximate_inverse.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Ifpack.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

#include <algorithm>
#include <string>

namespace softcell
{
  namespace
  {
    /// Throws if any rank has an error, which may be that of its own factors. Collective.
    void check_trilinos(const int error, const std::string &what, const Epetra_Comm &communicator)
    {
      int mine = error, lowest = 0;
      communicator.MinAll(&mine, &lowest, 1);
      if (lowest < 0)
        throw NotConverged(what + " of Trilinos failed with error " + std::to_string(lowest));
    }

    /// An Epetra copy of a BlockMatrix. Epetra numbers this rank's columns first and the others
    /// after them, each in ascending order, and stores a row in that order.
    class EpetraMatrix
    {
    public:
      explicit EpetraMatrix(const BlockMatrix &matrix)
          : communicator_(matrix.partitioner()->get_mpi_communicator()),
            rows_(-1, int(matrix.partitioner()->locally_owned_size()), 0, communicator_),
            matrix_(::Copy, rows_, column_map(matrix), row_lengths(matrix).data(), true)
      {
        std::vector<int> columns;
        std::vector<double> zeros;
        for (int row = 0; row < rows_.NumMyElements(); ++row)
        {
          columns.clear();
          for (std::size_t k = matrix.row_start()[row / 3]; k < matrix.row_start()[row / 3 + 1];
               ++k)
            for (unsigned int c = 0; c < 3; ++c)
              columns.push_back(matrix_.LCID(int(3 * matrix.columns()[k] + c)));
          zeros.resize(columns.size());
          matrix_.InsertMyValues(row, columns.size(), zeros.data(), columns.data());
        }
        matrix_.FillComplete(rows_, rows_);
        copy(matrix);
      }

      /// Takes the values, three runs of memory to a row: of this rank's columns, of those before,
      /// of those after.
      void copy(const BlockMatrix &matrix)
      {
        const auto [first, end] = matrix.partitioner()->local_range();
        int *row_start, *columns;
        double *target;
        matrix_.ExtractCrsDataPointers(row_start, columns, target);
        for (unsigned int node = 0; node < (end - first) / 3; ++node)
        {
          const std::size_t begin = matrix.row_start()[node], last = matrix.row_start()[node + 1];
          const auto row       = matrix.columns().begin();
          const auto own_begin = std::lower_bound(row + begin, row + last, first / 3) - row;
          const auto own_end   = std::lower_bound(row + own_begin, row + last, end / 3) - row;
          const double *source = matrix.values().data() + 9 * begin;
          for (unsigned int a = 0; a < 3; ++a, source += 3 * (last - begin))
          {
            const auto block = [&](const std::size_t k) { return source + 3 * (k - begin); };
            target           = std::copy(block(own_begin), block(own_end), target);
            target           = std::copy(block(begin), block(own_begin), target);
            target           = std::copy(block(own_end), block(last), target);
          }
        }
      }

      Epetra_CrsMatrix &operator*()
      {
        return matrix_;
      }

      Epetra_Vector view(const Vector &vector) const
      {
        return {::View, rows_, const_cast<double *>(vector.begin())};
      }

    private:
      Epetra_Map column_map(const BlockMatrix &matrix) const
      {
        const auto [first, end] = matrix.partitioner()->local_range();
        std::vector<int> columns, others;
        for (unsigned int i = first; i < end; ++i)
          columns.push_back(i);
        for (std::size_t k = 0; k < matrix.row_start()[(end - first) / 3]; ++k)
          if (3 * matrix.columns()[k] < first || 3 * matrix.columns()[k] >= end)
            others.push_back(matrix.columns()[k]);
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        for (const int node : others)
          columns.insert(columns.end(), {3 * node, 3 * node + 1, 3 * node + 2});
        return {-1, int(columns.size()), columns.data(), 0, communicator_};
      }

      static std::vector<int> row_lengths(const BlockMatrix &matrix)
      {
        std::vector<int> lengths(matrix.partitioner()->locally_owned_size());
        for (unsigned int row = 0; row < lengths.size(); ++row)
          lengths[row] = 3 * (matrix.row_start()[row / 3 + 1] - matrix.row_start()[row / 3]);
        return lengths;
      }

      Epetra_MpiComm communicator_;
      Epetra_Map rows_;
      Epetra_CrsMatrix matrix_;
    };

    void copy_or_create(std::unique_ptr<EpetraMatrix> &copy, const BlockMatrix &matrix)
    {
      if (copy)
        copy->copy(matrix);
      else
        copy = std::make_unique<EpetraMatrix>(matrix);
    }

    class IncompleteCholesky : public ApproximateInverse
    {
    public:
      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> & /*positions*/,
                      const std::vector<unsigned int> & /*constrained*/) override
      {
        copy_or_create(matrix_, matrix);
        if (!inverse_)
        {
          inverse_.reset(Ifpack().Create("IC", &**matrix_, 0));
          check_trilinos(inverse_->Initialize(), "Incomplete Cholesky", (**matrix_).Comm());
        }
        check_trilinos(inverse_->Compute(), "Incomplete Cholesky", (**matrix_).Comm());
      }

      void vmult(Vector &y, const Vector &x) const override
      {
        Epetra_Vector target = matrix_->view(y);
        check_trilinos(inverse_->ApplyInverse(matrix_->view(x), target), "Incomplete Cholesky",
                       (**matrix_).Comm());
      }

    private:
      std::unique_ptr<EpetraMatrix> matrix_;
      std::unique_ptr<Ifpack_Preconditioner> inverse_;
    };

    class SmoothedAggregation : public ApproximateInverse
    {
    public:
      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> &positions,
                      const std::vector<unsigned int> &constrained) override
      {
        copy_or_create(matrix_, matrix);
        null_space_.clear();
        null_space_.reserve(1); // ML wants a pointer even on a rank without nodes
        const auto modes = rigid_body_modes(matrix.partitioner(), positions, constrained);
        for (const Vector &mode : modes)
          null_space_.insert(null_space_.end(), mode.begin(),
                             mode.begin() + mode.locally_owned_size());

        Teuchos::ParameterList list;
        ML_Epetra::SetDefaults("SA", list);
        list.set("ML output", 0);
        list.set("PDE equations", 3);
        list.set("null space: type", "pre-computed");
        list.set("null space: dimension", int(modes.size()));
        list.set("null space: vectors", null_space_.data());
        list.set("aggregation: type", "Uncoupled");
        list.set("smoother: type", "Chebyshev");
        list.set("smoother: sweeps", 2);
        list.set("coarse: type", "Amesos-KLU");
        inverse_ = std::make_unique<ML_Epetra::MultiLevelPreconditioner>(**matrix_, list);
      }

      void vmult(Vector &y, const Vector &x) const override
      {
        Epetra_Vector target = matrix_->view(y);
        check_trilinos(inverse_->ApplyInverse(matrix_->view(x), target), "Multigrid",
                       (**matrix_).Comm());
      }

    private:
      std::unique_ptr<EpetraMatrix> matrix_;
      std::vector<double> null_space_;
      std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> inverse_;
    };
  } // namespace

  std::unique_ptr<ApproximateInverse> make_trilinos_inverse(const Approximation approximation)
  {
    if (approximation == Approximation::multigrid)
      return std::make_unique<SmoothedAggregation>();
    return std::make_unique<IncompleteCholesky>();
  }
} // namespace softcell
