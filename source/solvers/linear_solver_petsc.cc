// SPDX-License-Identifier: LGPL-2.1-or-later
// ICC, GAMG and MUMPS, through PETSc.

#include <softcell/base/exceptions.h>
#include <softcell/solvers/approximate_inverse.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <petscksp.h>

#include <algorithm>
#include <string>

namespace softcell
{
  namespace
  {
    void check_petsc(const PetscErrorCode error)
    {
      if (error != 0)
        throw std::runtime_error("PETSc failed with error " + std::to_string(error) + '.');
    }

    class PETScInverse : public ApproximateInverse
    {
    public:
      explicit PETScInverse(const Approximation approximation) : approximation_(approximation) {}

      ~PETScInverse() override
      {
        VecDestroy(&x_);
        VecDestroy(&y_);
        PCDestroy(&inverse_);
        MatDestroy(&matrix_);
      }

      void set_matrix(const BlockMatrix &matrix,
                      const std::vector<Point> &positions,
                      const std::vector<unsigned int> &constrained) override
      {
        if (matrix_ == nullptr)
        {
          create_matrix(matrix);
          create_inverse();
        }
        else
          check_petsc(MatUpdateMPIAIJWithArray(matrix_, matrix.values().data()));
        if (approximation_ == Approximation::multigrid)
          set_near_null_space(rigid_body_modes(matrix.partitioner(), positions, constrained));

        check_petsc(PCSetOperators(inverse_, matrix_, matrix_));
        check_petsc(PCSetUp(inverse_));
        if (approximation_ == Approximation::incomplete_cholesky)
          set_up_incomplete_cholesky();
        PCFailedReason failed;
        check_petsc(PCGetFailedReason(inverse_, &failed)); // perhaps of this rank's block alone
        if (dealii::Utilities::MPI::max(int(failed != PC_NOERROR),
                                        matrix.partitioner()->get_mpi_communicator()) != 0)
          throw NotConverged("PETSc cannot factorise the matrix: it is singular or memory ran out");
      }

      void vmult(Vector &y, const Vector &x) const override
      {
        check_petsc(VecPlaceArray(x_, x.begin()));
        check_petsc(VecPlaceArray(y_, y.begin()));
        check_petsc(PCApply(inverse_, x_, y_));
        check_petsc(VecResetArray(x_));
        check_petsc(VecResetArray(y_));
      }

    private:
      void create_matrix(const BlockMatrix &matrix);
      void create_inverse();
      void set_near_null_space(const std::vector<Vector> &modes);
      void set_up_incomplete_cholesky();

      const Approximation approximation_;
      Mat matrix_ = nullptr;
      PC inverse_ = nullptr;
      Vec x_ = nullptr, y_ = nullptr; // without memory of their own
    };

    void PETScInverse::create_matrix(const BlockMatrix &matrix)
    {
      const Partitioner &unknowns = *matrix.partitioner();
      const MPI_Comm communicator = unknowns.get_mpi_communicator();
      const PetscInt n_rows       = unknowns.locally_owned_size();
      std::vector<PetscInt> row_start{0}, columns;
      for (PetscInt row = 0; row < n_rows; ++row)
      {
        for (std::size_t k = matrix.row_start()[row / 3]; k < matrix.row_start()[row / 3 + 1]; ++k)
          for (unsigned int c = 0; c < 3; ++c)
            columns.push_back(3 * matrix.columns()[k] + c);
        row_start.push_back(columns.size());
      }
      check_petsc(MatCreate(communicator, &matrix_));
      check_petsc(MatSetSizes(matrix_, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE));
      check_petsc(MatSetType(matrix_, MATMPIAIJ));
      check_petsc(MatSetBlockSize(matrix_, 3));
      check_petsc(MatMPIAIJSetPreallocationCSR(matrix_, row_start.data(), columns.data(),
                                               matrix.values().data()));
      if (approximation_ != Approximation::factors) // near enough for a preconditioner
      {
        check_petsc(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
        check_petsc(MatSetOption(matrix_, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
      }
      for (Vec *const vector : {&x_, &y_})
        check_petsc(
          VecCreateMPIWithArray(communicator, 3, n_rows, unknowns.size(), nullptr, vector));
    }

    void PETScInverse::create_inverse()
    {
      MPI_Comm communicator;
      check_petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(matrix_), &communicator));
      check_petsc(PCCreate(communicator, &inverse_));
      check_petsc(PCSetOperators(inverse_, matrix_, matrix_));
      switch (approximation_)
      {
        case Approximation::incomplete_cholesky:
          check_petsc(PCSetType(inverse_, PCBJACOBI));
          break;
        case Approximation::multigrid:
          check_petsc(PCSetType(inverse_, PCGAMG));
          break;
        case Approximation::symmetric_factors:
        case Approximation::factors:
          check_petsc(
            PCSetType(inverse_, approximation_ == Approximation::factors ? PCLU : PCCHOLESKY));
          check_petsc(PCFactorSetMatSolverType(inverse_, MATSOLVERMUMPS));
          check_petsc(PCFactorSetUpMatSolverType(inverse_));
          Mat factors;
          check_petsc(PCFactorGetMatrix(inverse_, &factors));
          check_petsc(MatMumpsSetIcntl(factors, 14, 60)); // per cent of memory beyond the estimate
          break;
      }
    }

    void PETScInverse::set_near_null_space(const std::vector<Vector> &modes)
    {
      std::vector<Vec> vectors(modes.size());
      for (unsigned int m = 0; m < modes.size(); ++m)
      {
        check_petsc(VecDuplicate(x_, &vectors[m]));
        PetscScalar *values;
        check_petsc(VecGetArray(vectors[m], &values));
        std::copy_n(modes[m].begin(), modes[m].locally_owned_size(), values);
        check_petsc(VecRestoreArray(vectors[m], &values));
      }
      MatNullSpace space;
      check_petsc(MatNullSpaceCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix_)),
                                     PETSC_FALSE, vectors.size(), vectors.data(), &space));
      check_petsc(MatSetNearNullSpace(matrix_, space));
      check_petsc(MatNullSpaceDestroy(&space));
      for (Vec &vector : vectors)
        check_petsc(VecDestroy(&vector));
    }

    /// The blocks of block Jacobi exist only after PCSetUp().
    void PETScInverse::set_up_incomplete_cholesky()
    {
      KSP *blocks;
      PetscInt n_blocks;
      check_petsc(PCBJacobiGetSubKSP(inverse_, &n_blocks, nullptr, &blocks));
      for (PetscInt i = 0; i < n_blocks; ++i)
      {
        PC factors;
        check_petsc(KSPGetPC(blocks[i], &factors));
        check_petsc(PCSetType(factors, PCICC));
        check_petsc(PCFactorSetShiftType(factors, MAT_SHIFT_POSITIVE_DEFINITE));
      }
      check_petsc(PCSetUpOnBlocks(inverse_));
    }
  } // namespace

  std::unique_ptr<ApproximateInverse> make_petsc_inverse(const Approximation approximation)
  {
    return std::make_unique<PETScInverse>(approximation);
  }
} // namespace softcell
