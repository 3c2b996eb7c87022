// The walls of scene files as their states hand them out.
#include "scenes/sources/wall_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"
#include "tracking/field/metaballs/field_walls.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::scenes::wall_points_test {
namespace {

Scene scene_with(const std::string& boundaries, const std::string& tracking = "{}",
                 const std::string& particles = R"("source": "simulation")") {
  const std::string text = R"({"frames": 2, "particles": {"spacing": 0.05, )" + particles +
                           R"(},
    "bodies": [{"shape": "ball", "center": [0, 0.5, 0], "radius": 0.2}], "tracking": )" +
                           tracking + R"(, "boundaries": )" + boundaries + "}";
  return parse_scene(text, "test", FLOWSKIN_SOURCE_DIR "/scenes");
}

tracking::FieldWalls walls_at(const Scene& scene, double time) {
  return tracking::field_walls(sample_walls(scene), time, tracking::default_field_settings(scene.particles.spacing));
}

TEST(WallPoints, NoneWithoutWallsOrShare) {
  EXPECT_TRUE(walls_at(scene_with("[]"), 0).empty());
  EXPECT_TRUE(walls_at(scene_with(R"([{"file": "meshes/stairs.obj"}])", R"({"wall_share": 0})"), 0).empty());
  EXPECT_FALSE(walls_at(scene_with(R"([{"file": "meshes/stairs.obj"}])"), 0).empty());
}

TEST(WallPoints, FacesInCommonCountOnce) {
  const auto once = walls_at(scene_with(R"([{"file": "meshes/stairs.obj"}])"), 0);
  const auto twice = walls_at(scene_with(R"([{"file": "meshes/stairs.obj"}, {"file": "meshes/stairs.obj"}])"), 0);
  ASSERT_EQ(once.size(), 1U);
  ASSERT_EQ(twice.size(), 1U);
  // A few more fill what the sampler takes for gaps.
  EXPECT_NEAR(double(twice.front()->positions().size()) / double(once.front()->positions().size()), 1, 0.03);
  // About one point per square spacing: the flight of stairs has 11.688 m^2.
  const double expected = 11.688 / (0.05 * 0.05);
  EXPECT_NEAR(double(once.front()->positions().size()) / expected, 1, 0.1);
}

TEST(WallPoints, MoveByTheirKeyframes) {
  const Scene scene =
      scene_with(R"([{"file": "meshes/paddle.obj", "keyframes": [{"time": 0}, {"time": 2, "translate": [0, 1, 0]}]}])");
  const auto early = walls_at(scene, 0), later = walls_at(scene, 1);
  ASSERT_EQ(early.size(), 1U);
  ASSERT_EQ(later.size(), 1U);
  const auto &from = early.front()->positions(), &to = later.front()->positions();
  ASSERT_EQ(from.size(), to.size());
  ASSERT_GT(from.size(), 50U);
  for (std::size_t i = 0; i < from.size(); ++i) EXPECT_LE((to[i] - from[i] - Vec3(0, 0.5, 0)).norm(), 1e-12);
}

TEST(WallPoints, AreSampledOnceForAllStates) {
  for (const std::string particles :
       {R"("source": "simulation")",
        R"("source": "prescribed", "motion": {"type": "translation", "velocity": [1, 0, 0]})"}) {
    Scene scene = scene_with(R"([{"file": "meshes/stairs.obj", "hollow": true}])", "{}", particles);
    const auto source = make_source(scene);
    const tracking::Walls first = source->state().walls;
    ASSERT_EQ(first.size(), 1U);
    source->advance_to(0.01);
    EXPECT_EQ(source->state().walls, first) << "the same object, not another one with the same points";
  }
}

}  // namespace
}  // namespace flowskin::scenes::wall_points_test
