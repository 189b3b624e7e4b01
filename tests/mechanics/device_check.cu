// SPDX-License-Identifier: LGPL-2.1-or-later
// Compiled where nvcc is found: the laws are code for the device too. Nothing of it runs.

#include <softcell/mechanics/laws.h>

template <class Law>
__global__ void stress_and_tangent(const Law law,
                                   const softcell::Matrix3<float> *F,
                                   const softcell::Matrix3<float> *dF,
                                   softcell::Matrix3<float> *P,
                                   softcell::Matrix3<float> *dP)
{
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (!law.is_admissible(determinant(F[i])))
    return;
  P[i]  = law.first_piola_stress(F[i]);
  dP[i] = law.linearisation(F[i])(dF[i]);
}

template __global__ void stress_and_tangent(softcell::NeoHookean<float>,
                                            const softcell::Matrix3<float> *,
                                            const softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *);
template __global__ void stress_and_tangent(softcell::SaintVenantKirchhoff<float>,
                                            const softcell::Matrix3<float> *,
                                            const softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *);
template __global__ void stress_and_tangent(softcell::LinearElastic<float>,
                                            const softcell::Matrix3<float> *,
                                            const softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *,
                                            softcell::Matrix3<float> *);
