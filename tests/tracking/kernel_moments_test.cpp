// How the field answers to a strain of its particles, against the field's time derivatives in that motion.
#include "tracking/field/kernel_moments.h"

#include <gtest/gtest.h>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tracking::kernel_moments_test {
namespace {

TEST(KernelMoments, GiveTheRatesOfEveryAffineMotion) {
  test::Random random(71);
  const FieldSettings settings{0.7, 0.3, 2.5};
  const std::vector<Vec3> particles = test::lattice(0.3, 3, 0.3, 72, [](const Vec3& x) { return x.norm() < 0.9; });
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 x = 0.8 * random.vector(), v = random.vector();
    Mat3 gradient;
    for (int column = 0; column < 3; ++column) gradient.col(column) = random.vector();
    const auto flow = [&](const Vec3& y) { return Vec3(v + gradient * (y - x)); };
    const MetaballField field(particles, test::velocities_of(particles, flow), settings);

    const KernelMoments moments = field.moments(x);
    StrainResponse response;  // lengths in radii, kernel weight 1
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        const StrainResponse one = moments.response(row, column);
        response.value += gradient(row, column) * one.value;
        response.gradient += gradient(row, column) * one.gradient;
        response.hessian += gradient(row, column) * one.hessian;
      }
    }
    const MotionJet jet = field.motion_jet(x);
    const double w = settings.weight, r = settings.radius;
    EXPECT_NEAR(jet.value_rate + jet.gradient.dot(v), w * response.value, 1e-11 * w);
    EXPECT_LT((jet.gradient_rate + jet.hessian * v - w / r * response.gradient).norm(), 1e-10 * w / r);
    Mat3 carried = jet.hessian_rate;
    for (int k = 0; k < 3; ++k) carried += v[k] * jet.third[k];
    EXPECT_LT((carried - w / (r * r) * response.hessian).norm(), 1e-9 * w / (r * r));
    EXPECT_LT((moments.gradient * w / r - jet.gradient).norm(), 1e-11 * w / r);
  }
}

TEST(KernelMoments, AreZeroWhereNoParticleIsNear) {
  const MetaballField field({Vec3::Zero()}, {}, {1, 0.5, 1});
  const KernelMoments moments = field.moments(Vec3(3, 0, 0));
  EXPECT_EQ(moments.gradient, Vec3::Zero());
  EXPECT_EQ(moments.response(0, 1).hessian, Mat3::Zero());
}

}  // namespace
}  // namespace flowskin::tracking::kernel_moments_test
