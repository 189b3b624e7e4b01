// SPDX-License-Identifier: LGPL-2.1-or-later
// Every law against its energy's derivatives, the symmetries of mechanics and formulas of its own.

#include <softcell/mechanics/laws.h>

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <experimental/simd>
#include <vector>

namespace Sacado::Fad::Exp
{
  template <class Storage>
  GeneralFad<Storage> log1p(const GeneralFad<Storage> &x)
  {
    GeneralFad<Storage> y = log(1 + x);
    y.val()               = std::log1p(x.val());
    return y;
  }
} // namespace Sacado::Fad::Exp

namespace
{
  using namespace softcell;
  namespace stdx = std::experimental;

  constexpr double E = 5000, nu = 0.3, mu = E / 2.6, lambda = E * 0.3 / (1.3 * 0.4);

  const Matrix3<double> F1{{1.2, 0.3, -0.1, -0.2, 0.9, 0.25, 0.15, -0.05, 1.1}};
  const Matrix3<double> F2{{0.7, -0.2, 0.4, 0.1, 1.6, 0.3, 0.2, 0.35, 0.8}};
  const Matrix3<double> dF1{{0.3, -0.5, 0.2, 0.7, 0.1, -0.4, -0.6, 0.25, 0.9}};
  const Matrix3<double> dF2{{-0.2, 0.4, 0.6, 0.3, -0.8, 0.15, 0.5, -0.1, 0.35}};

  // Turns by 120 degrees about (1, 1, 1), then by the angle a about z.
  Matrix3<double> rotation(const double a)
  {
    const Matrix3<double> cyclic{{0, 0, 1, 1, 0, 0, 0, 1, 0}};
    const Matrix3<double> about_z{
      {std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1}};
    return about_z * cyclic;
  }

  void expect_near(const Matrix3<double> &A, const Matrix3<double> &B, const double tolerance)
  {
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(A.entries[k], B.entries[k], tolerance) << "entry " << k;
  }

  template <class T>
  class Laws : public testing::Test
  {
  };
  using AllLaws =
    testing::Types<NeoHookean<>, SaintVenantKirchhoff<>, LinearElastic<>, InvertibleNeoHookean<>>;
  TYPED_TEST_SUITE(Laws, AllLaws);

  // At a point without weight, where F may be anything, a kernel's law has moduli of 0.
  TYPED_TEST(Laws, HaveNoTangentWithoutModuli)
  {
    for (const Matrix3<double> &F :
         {Matrix3<double>{{1, 0, 0, 0, 1, 0, 0, 0, 0}}, Matrix3<double>{},
          Matrix3<double>{{-1, 0, 0, 0, 1, 0, 0, 0, 1}}})
      expect_near(TypeParam{0, 0}.linearisation(F, 0.)(dF1), Matrix3<double>{}, 0);
  }

  template <class T>
  class FiniteStrainLaws : public testing::Test
  {
  };
  using FiniteStrain = testing::Types<NeoHookean<>, SaintVenantKirchhoff<>, InvertibleNeoHookean<>>;
  TYPED_TEST_SUITE(FiniteStrainLaws, FiniteStrain);

  TYPED_TEST(Laws, StressAndTangentAreDerivativesByAutomaticDifferentiation)
  {
    using Fad = Sacado::Fad::SFad<double, 9>;
    const TypeParam law{lambda, mu};
    for (const Matrix3<double> &F : {identity<double>(), F1, F2})
    {
      Matrix3<Fad> F_ad;
      for (int k = 0; k < 9; ++k)
        F_ad.entries[k] = Fad(9, k, F.entries[k]);
      const Fad W             = law.energy(F_ad);
      const Matrix3<Fad> P_ad = law.first_piola_stress(F_ad);
      const Matrix3<double> P = law.first_piola_stress(F);
      Matrix3<double> dP{};
      for (int k = 0; k < 9; ++k)
      {
        EXPECT_NEAR(P.entries[k], W.dx(k), 1e-10 * E);
        for (int l = 0; l < 9; ++l)
          dP.entries[k] += P_ad.entries[k].dx(l) * dF1.entries[l];
      }
      expect_near(law.linearisation(F)(dF1), dP, 1e-10 * E);
    }
  }

  TYPED_TEST(Laws, StressAndTangentAreDerivativesByFiniteDifferences)
  {
    const TypeParam law{lambda, mu};
    const double h = 1e-5;
    for (const Matrix3<double> &F : {F1, F2})
    {
      const Matrix3<double> up = F + h * dF1, down = F - h * dF1;
      EXPECT_NEAR(double_contraction(law.first_piola_stress(F), dF1),
                  (law.energy(up) - law.energy(down)) / (2 * h), 1e-7 * E);
      expect_near(law.linearisation(F)(dF1),
                  1 / (2 * h) * (law.first_piola_stress(up) - law.first_piola_stress(down)),
                  1e-7 * E);
    }
  }

  TYPED_TEST(Laws, TangentIsSymmetric)
  {
    const auto tangent = TypeParam{lambda, mu}.linearisation(F1);
    EXPECT_NEAR(double_contraction(dF2, tangent(dF1)), double_contraction(dF1, tangent(dF2)),
                1e-12 * E);
  }

  TYPED_TEST(Laws, TangentOfANodalGradientIsThatOfItsMatrix)
  {
    const auto tangent = TypeParam{lambda, mu}.linearisation(F1);
    for (int b = 0; b < 3; ++b)
    {
      Matrix3<double> dF{};
      for (int A = 0; A < 3; ++A)
        dF(b, A) = dF1(0, A);
      const NodalGradient<double> nodal{b, {dF1(0, 0), dF1(0, 1), dF1(0, 2)}};
      expect_near(tangent(nodal), tangent(dF), 1e-12 * E);
    }
  }

  TYPED_TEST(Laws, NothingHappensAtRest)
  {
    const TypeParam law{lambda, mu};
    EXPECT_EQ(law.energy(identity<double>()), 0);
    expect_near(law.first_piola_stress(identity<double>()), {}, 0);
  }

  TYPED_TEST(Laws, SmallStrainsFollowHooke)
  {
    const TypeParam law{lambda, mu};
    const double h              = 1e-7;
    const Matrix3<double> e     = 0.5 * (dF1 + transpose(dF1));
    const Matrix3<double> sigma = lambda * trace(e) * identity<double>() + 2 * mu * e;
    const Matrix3<double> F     = identity<double>() + h * dF1;
    expect_near(1 / h * law.first_piola_stress(F), sigma, 1e-5 * E);
    expect_near(1 / h * law.cauchy_stress(F), sigma, 1e-5 * E);
    expect_near(law.linearisation(identity<double>())(dF1), sigma, 1e-12 * E);
    // The energy keeps its digits though its terms are 1e7 times as large.
    EXPECT_NEAR(law.energy(F) / (h * h), 0.5 * double_contraction(sigma, e), 1e-5 * E);
  }

  TYPED_TEST(Laws, APackComputesWhatItsLanesDo)
  {
    using Pack = stdx::native_simd<double>;
    const TypeParam law{lambda, mu};
    Matrix3<Pack> F, dF;
    for (int k = 0; k < 9; ++k)
    {
      F.entries[k]  = Pack([&](int lane) { return F1.entries[k] + 0.01 * lane * dF2.entries[k]; });
      dF.entries[k] = Pack([&](int lane) { return dF1.entries[k] + lane * dF2.entries[k]; });
    }
    const Pack W                 = law.energy(F);
    const Matrix3<Pack> P        = law.first_piola_stress(F);
    const Matrix3<Pack> dP       = law.linearisation(F)(dF);
    const Matrix3<Pack> dP_at_F1 = law.linearisation(F1)(dF);
    EXPECT_TRUE(stdx::all_of(law.is_admissible(determinant(F))));
    for (std::size_t lane = 0; lane < Pack::size(); ++lane)
    {
      const Matrix3<double> F_l  = F1 + 0.01 * double(lane) * dF2;
      const Matrix3<double> dF_l = dF1 + double(lane) * dF2;
      EXPECT_NEAR(W[lane], law.energy(F_l), 1e-12 * E);
      const Matrix3<double> P_l  = law.first_piola_stress(F_l);
      const Matrix3<double> dP_l = law.linearisation(F_l)(dF_l), dP_1 = law.linearisation(F1)(dF_l);
      for (int k = 0; k < 9; ++k)
      {
        EXPECT_NEAR(P.entries[k][lane], P_l.entries[k], 1e-12 * E);
        EXPECT_NEAR(dP.entries[k][lane], dP_l.entries[k], 1e-11 * E);
        EXPECT_NEAR(dP_at_F1.entries[k][lane], dP_1.entries[k], 1e-11 * E);
      }
    }
  }

  TYPED_TEST(FiniteStrainLaws, TheFrameDoesNotMatterNorDoesTheOrientationOfTheBody)
  {
    const TypeParam law{lambda, mu};
    const Matrix3<double> Q = rotation(0.7);
    for (const Matrix3<double> &F : {F1, F2})
    {
      const Matrix3<double> P = law.first_piola_stress(F);
      EXPECT_NEAR(law.energy(Q * F), law.energy(F), 1e-12 * E);
      expect_near(law.first_piola_stress(Q * F), Q * P, 1e-12 * E);
      EXPECT_NEAR(law.energy(F * Q), law.energy(F), 1e-12 * E);
      expect_near(law.first_piola_stress(F * Q), P * Q, 1e-12 * E);
    }
    expect_near(law.first_piola_stress(Q), {}, 1e-12 * E);
    EXPECT_NEAR(law.energy(Q), 0, 1e-12 * E);
  }

  TYPED_TEST(FiniteStrainLaws, TheCauchyStressIsSymmetricAndThatOfPiola)
  {
    const TypeParam law{lambda, mu};
    const Matrix3<double> sigma = law.cauchy_stress(F1);
    expect_near(determinant(F1) * (sigma * transpose(inverse(F1))), law.first_piola_stress(F1),
                1e-12 * E);
    expect_near(sigma, transpose(sigma), 1e-12 * E);
  }

  TYPED_TEST(FiniteStrainLaws, AnInvertedPointIsReported)
  {
    EXPECT_TRUE(TypeParam::is_admissible(1e-9));
    EXPECT_FALSE(TypeParam::is_admissible(std::nan("")));
    const bool is_invertible = std::is_same_v<TypeParam, InvertibleNeoHookean<>>;
    for (const double J : {0., -0.1})
      EXPECT_EQ(TypeParam::is_admissible(J), is_invertible);
  }

  // Uniaxial stretch k: the principal stresses by hand from eq. 2.8 and 2.9.
  TEST(Laws, UniaxialStretchByHand)
  {
    const double k = 1.7;
    const Matrix3<double> F{{k, 0, 0, 0, 1, 0, 0, 0, 1}};

    const NeoHookean<> neo_hookean{lambda, mu};
    EXPECT_NEAR(neo_hookean.energy(F),
                mu / 2 * (k * k - 1) - mu * std::log(k) + lambda / 2 * std::pow(std::log(k), 2),
                1e-12 * E);
    expect_near(neo_hookean.first_piola_stress(F),
                {{mu * (k - 1 / k) + lambda * std::log(k) / k, 0, 0, 0, lambda * std::log(k), 0, 0,
                  0, lambda * std::log(k)}},
                1e-12 * E);

    const double strain = (k * k - 1) / 2;
    const SaintVenantKirchhoff<> svk{lambda, mu};
    EXPECT_NEAR(svk.energy(F), (lambda / 2 + mu) * strain * strain, 1e-12 * E);
    expect_near(
      svk.first_piola_stress(F),
      {{k * (lambda + 2 * mu) * strain, 0, 0, 0, lambda * strain, 0, 0, 0, lambda * strain}},
      1e-12 * E);
  }

  // P = F S, with shear. F1 and F2 are far from where the invertible law departs from the other.
  TEST(Laws, StressesAreThoseOfTheRightCauchyGreenTensor)
  {
    const Matrix3<double> I = identity<double>();
    for (const Matrix3<double> &F : {F1, F2})
    {
      const Matrix3<double> C = transpose(F) * F, C_inverse = inverse(C);
      const double log_J           = 0.5 * std::log(determinant(C));
      const Matrix3<double> S      = mu * (I - C_inverse) + lambda * log_J * C_inverse,
                            strain = 0.5 * (C - I),
                            S_of_E = lambda * trace(strain) * I + 2 * mu * strain;
      expect_near((NeoHookean<>{lambda, mu}.first_piola_stress(F)), F * S, 1e-12 * E);
      expect_near((InvertibleNeoHookean<>{lambda, mu}.first_piola_stress(F)), F * S, 1e-12 * E);
      expect_near((SaintVenantKirchhoff<>{lambda, mu}.first_piola_stress(F)), F * S_of_E,
                  1e-12 * E);
    }
  }

  TEST(Laws, LinearElasticityAcceptsAnyNumberButNotNaN)
  {
    EXPECT_TRUE(LinearElastic<>::is_admissible(-1.));
    EXPECT_FALSE(LinearElastic<>::is_admissible(std::nan("")));
  }

  TEST(Laws, FloatIsDoubleToItsPrecision)
  {
    const auto law = make_law<NeoHookean>(5000.f, 0.3f);
    Matrix3<float> F;
    for (int k = 0; k < 9; ++k)
      F.entries[k] = static_cast<float>(F1.entries[k]);
    const Matrix3<float> P          = law.first_piola_stress(F);
    const Matrix3<double> reference = NeoHookean<>{lambda, mu}.first_piola_stress(F1);
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(P.entries[k], reference.entries[k], 1e-5 * E);
  }
} // namespace
