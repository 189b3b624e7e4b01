// SPDX-License-Identifier: LGPL-2.1-or-later
// Multigrid on a graphics card.
#pragma once

#include <softcell/operators/cuda_elasticity.h>
#include <softcell/solvers/card_levels.h>
#include <softcell/solvers/cuda_cg.h>

#include <memory>
#include <vector>

namespace softcell
{
  /// What GeometricMultigrid does, on a device: Cuda, or Serial, which runs the same kernels on the
  /// host. The body is supported by unknowns that are held and by nothing else.
  ///
  /// A V-cycle is nothing but kernels, without a word from the host. What a tangent's product needs
  /// for the smoother is done where it is summed up at the nodes, so that a step of the smoother is
  /// two kernels. The host makes the coarse grids and displacements and inverts the coarsest
  /// matrix.
  template <class Real, class Device>
  class CudaMultigrid
  {
  public:
    template <class Number>
    using Field = DeviceArray<Number, Device>;

    /// @param held    entries of a LatticeVector whose unknowns are not free.
    /// @param degree  of the finest grid's smoother.
    /// @throws BadInput if cells have points of their own.
    CudaMultigrid(const CellLattice &cells,
                  const Material &material,
                  const std::vector<std::size_t> &held,
                  unsigned int degree = 4);

    ~CudaMultigrid();

    /// Takes the displacement at which the tangents are formed. @throws InvertedPoint,
    /// or NotConverged if a grid's tangent is not positive definite
    /// @param smoother  see GeometricMultigrid::set_smoother().
    template <class Number>
    void set_state(const Field<Number> &u, Tangent smoother = Tangent::definite);

    /// See GeometricMultigrid::set_smoother().
    void set_smoother(Tangent tangent);

    /// y = K^-1 x, nearly, for an x that is 0 in unknowns that are not free.
    template <class Number>
    void vmult(Field<Number> &y, const Field<Number> &x);

    /// Of the finest grid, see CudaElasticity::hold().
    const std::vector<unsigned char> &held() const
    {
      return held_;
    }

  private:
    struct Level;

    void estimate_eigenvalue(Level &level, Tangent tangent);
    void invert_coarsest();
    void smooth(Level &level);
    void cycle(unsigned int level);

    CardLevels<Real> grids_;
    std::vector<unsigned char> held_;
    std::vector<std::unique_ptr<Level>> levels_; // from the finest on
    Tangent smoother_ = Tangent::definite;       // of the finest
    typename Device::Recording recorded_cycle_;
    DeviceArray<int, Device> coarsest_entries_;    // (n)
    DeviceArray<double, Device> coarsest_inverse_; // (n, n)
  };
} // namespace softcell
