// The sloshing block: a flow without divergence, and files of it through the reader and the tracker.
#include <gtest/gtest.h>

#include "tools/experiments/sloshing_block.h"

namespace flowskin::tools::sloshing_block_test {
namespace {

TEST(SloshingBlock, FlowsWithoutDivergenceAndNotThroughItsWalls) {
  const double h = 1e-5;
  for (const Vec3& x : {Vec3(0.3, 0.4, 0.7), Vec3(1.6, 0.9, 0.1), Vec3(1, 0.5, 0.5)}) {
    double divergence = 0;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step = Vec3::Zero();
      step[axis] = h;
      divergence += (sloshing_velocity(x + step, 0.2) - sloshing_velocity(x - step, 0.2))[axis] / (2 * h);
    }
    EXPECT_NEAR(divergence, 0, 1e-9);
  }
  EXPECT_NEAR(sloshing_velocity({0, 0.3, 0.6}, 0.1).x(), 0, 1e-15);
  EXPECT_NEAR(sloshing_velocity({2, 0.3, 0.6}, 0.1).x(), 0, 1e-15);
  EXPECT_NEAR(sloshing_velocity({1.2, 0, 0.6}, 0.1).y(), 0, 1e-15);
}

TEST(SloshingBlock, PathsAreConverged) {
  const Vec3 start(0.4, 0.8, 0.2);
  const Vec3 usual = sloshing_path(start, 0, 16 / 24.0, 64), fine = sloshing_path(start, 0, 16 / 24.0, 640);
  EXPECT_GT((usual - start).norm(), 0.02);
  EXPECT_LT((usual - fine).norm(), 1e-9);
}

TEST(SloshingBlock, TheMoreTheFilesHoldTheNearerIsTheTexture) {
  const SloshingSettings small{10, 16};
  const auto errors = [&](std::size_t kind) { return sloshing_errors("hybrid", sloshing_files().at(kind), small); };
  const SloshingErrors all = errors(0), every_second = errors(5);
  EXPECT_GT(all.motion, 0.4);
  EXPECT_LT(all.median, 0.04 * all.motion);
  EXPECT_LT(every_second.median, 0.06 * all.motion);
  const SloshingErrors positions = sloshing_errors("affine", sloshing_files().at(3), small);
  EXPECT_LT(positions.median, 0.3 * all.motion);
  EXPECT_GT(positions.median, all.median);
  EXPECT_GT(sloshing_errors("normal", sloshing_files().at(0), small).median, 0.1 * all.motion);
}

}  // namespace
}  // namespace flowskin::tools::sloshing_block_test
