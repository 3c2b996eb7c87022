#include "sph/forces/kernels.h"

#include <gtest/gtest.h>

namespace flowskin::sph::kernels_test {
namespace {

template <typename Kernel>
class KernelTest : public testing::Test {};
using Kernels = testing::Types<WendlandC2, CubicSpline>;
TYPED_TEST_SUITE(KernelTest, Kernels);

constexpr double support = 0.7;

TYPED_TEST(KernelTest, IntegratesToOne) {
  double sum = 0;
  constexpr int pieces = 20000;
  for (int k = 0; k < pieces; ++k) {
    const double r = (k + 0.5) * support / pieces;
    sum += 4 * M_PI * r * r * TypeParam::value(r, support) * support / pieces;
  }
  EXPECT_NEAR(sum, 1, 1e-7);
}

TYPED_TEST(KernelTest, DerivativeMatchesDifferences) {
  for (double r = 0.01; r < support; r += 0.013) {
    const double step = 1e-6;
    const double difference = (TypeParam::value(r + step, support) - TypeParam::value(r - step, support)) / (2 * step);
    EXPECT_NEAR(TypeParam::derivative(r, support), difference, 1e-5 * TypeParam::value(0, support) / support) << r;
  }
}

TYPED_TEST(KernelTest, HasCompactSupport) {
  EXPECT_GT(TypeParam::value(0.99 * support, support), 0);
  for (const double r : {support, 1.5 * support}) {
    EXPECT_EQ(TypeParam::value(r, support), 0);
    EXPECT_EQ(TypeParam::derivative(r, support), 0);
  }
}

TYPED_TEST(KernelTest, IsContinuousWithItsDerivative) {
  const double value_scale = TypeParam::value(0, support), slope_scale = value_scale / support;
  for (int k = 1; k <= 2000; ++k) {
    const double r = support * k / 1990, before = r - support / 1990;
    EXPECT_NEAR(TypeParam::value(r, support), TypeParam::value(before, support), 0.003 * value_scale);
    EXPECT_NEAR(TypeParam::derivative(r, support), TypeParam::derivative(before, support), 0.03 * slope_scale);
  }
}

TYPED_TEST(KernelTest, EightLanesAgreeWithPlainFunctions) {
  for (int k = 0; k < 20; ++k) {
    Float8 q{};
    for (int lane = 0; lane < 8; ++lane) q[lane] = static_cast<float>(0.007 * (8 * k + lane));
    const Float8 shape = TypeParam::shape(q), value = TypeParam::scaled_value(q);
    for (int lane = 0; lane < 8; ++lane) {
      const double r = static_cast<double>(q[lane]) * support;
      EXPECT_NEAR(shape[lane], TypeParam::shape(static_cast<double>(q[lane])), 2e-6);
      EXPECT_NEAR(value[lane], TypeParam::value(r, support) * support * support * support, 5e-6);
    }
  }
}

}  // namespace
}  // namespace flowskin::sph::kernels_test
