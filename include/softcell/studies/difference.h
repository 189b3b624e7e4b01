// SPDX-License-Identifier: LGPL-2.1-or-later
// How far a discretization's displacement is from another's, or from a known one.
#pragma once

#include <softcell/discretization/methods.h>
#include <softcell/loads/manufactured_solution.h>
#include <softcell/mechanics/material.h>

namespace softcell
{
  /// Errors relative to a reference, over the body as the reference's integration points see it.
  struct Difference
  {
    double relative_l2     = 0; // |u - u_ref| / |u_ref| in L2
    double relative_h1     = 0; // the same of the gradients: |grad(u - u_ref)| / |grad u_ref| in L2
    double relative_stress = 0; // the same of the Cauchy stresses, over the reference configuration
    double missed          = 0; // fraction of the volume that was left out: no cell of the other
                                // discretization within reach
  };

  /// The difference of u on `discretization` from the reference (the norms of Brunet fig. 2.8 and
  /// 4.6). The two may be partitioned differently over the same ranks; both vectors have ghost
  /// values. Collective.
  /// @param materials one per label. Points where a law has no value count as free of stress.
  /// @param reach how far a point of the reference may lie outside the other's cells, which are
  ///              extended up to there. Units: m
  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &reference,
                        const Vector &reference_u,
                        const std::vector<Material> &materials,
                        double reach);

  /// The difference of u from a known displacement, by the points of finer_points(). Collective.
  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &points,
                        const ManufacturedSolution &exact,
                        const std::vector<Material> &materials,
                        double reach);

  /// How far vertices of a body's surface are from where a reference has them (Brunet fig. 4.14).
  struct SurfaceDifference
  {
    double mean = 0, max = 0; // of |u - u_ref|. Units: m
  };

  /// @param vertices the same on all ranks, none farther than the fields reach. Collective.
  SurfaceDifference surface_difference(const DisplacementField &field,
                                       const DisplacementField &reference,
                                       const std::vector<Point> &vertices);

  /// The integration points by which a discretization is measured against a known displacement:
  /// those of finite cells of its degree, two along each edge of a cell of its background grid as
  /// it was before any refinement, or of `Mesh size`. Its own would not do, since gradients are
  /// superconvergent there. Where cells are halved more than once, or a `Mesh file` has smaller
  /// ones than `Cells` make, several of them share one of these, and the errors are a sample.
  /// Collective.
  /// @param parameters,geometry what it and its body were made from.
  std::unique_ptr<Discretization> finer_points(const DiscretizationParameters &parameters,
                                               const GeometryParameters &geometry,
                                               const Body &body,
                                               MPI_Comm communicator);
} // namespace softcell
