// The checks themselves: each limit is seen where it is passed, and only there.
#include <gmock/gmock.h>

#include <functional>

#include "surfaces/surface_checks.h"

namespace flowskin::surfaces {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SceneMeasures sound_scene() {
  SceneMeasures scene;
  scene.name = "planted";
  for (int k = 0; k < 4; ++k) {
    FrameMeasures frame;
    frame.frame = k;
    frame.shape = frame.fresh_shape = {1, 2, 0};
    frame.hausdorff = frame.hausdorff_at_corners = limit::hausdorff;
    frame.volume_error = limit::volume;
    frame.field_distance = limit::field_distance;
    frame.narrow_triangles = limit::narrow_triangles;
    frame.odd_edges = limit::odd_edges;
    frame.ids_kept = limit::ids_kept;
    frame.material_drift = limit::material_drift;
    frame.vertices = 100;
    frame.volume = 1;
    scene.frames.push_back(frame);
  }
  return scene;
}

std::vector<std::string> sentences_of(const SceneMeasures& scene) {
  std::vector<std::string> sentences;
  for (const Violation& violation : violations(scene)) sentences.push_back(violation.sentence);
  return sentences;
}

TEST(SurfaceChecks, LimitsAreKeptUpToTheirValue) { EXPECT_THAT(sentences_of(sound_scene()), IsEmpty()); }

TEST(SurfaceChecks, EveryPlantedFaultIsNamedWithItsFrame) {
  const std::vector<std::pair<std::string, std::function<void(FrameMeasures&)>>> faults = {
      {"unsound mesh", [](auto& f) { f.problems = {"an edge is open"}; }},
      {"self-intersections", [](auto& f) { f.self_intersections = 1; }},
      {"components", [](auto& f) { f.shape.components = 2; }},
      {"Euler", [](auto& f) { f.shape.euler = 0; }},
      {"Hausdorff", [](auto& f) { f.hausdorff = 0.51; }},
      {"vertices and centres", [](auto& f) { f.hausdorff_at_corners = 0.51; }},
      {"volume", [](auto& f) { f.volume_error = 0.006; }},
      {"|f|", [](auto& f) { f.field_distance = 1.1e-3; }},
      {"10 degrees", [](auto& f) { f.narrow_triangles = 0.0011; }},
      {"0.5 to 1.5", [](auto& f) { f.odd_edges = 0.011; }},
      {"without a topology change", [](auto& f) { f.ids_kept = 0.97; }},
      {"with a topology change", [](auto& f) { f.ids_kept = 0.89, f.change = true; }},
      {"guard", [](auto& f) { f.reextractions = 1; }},
      {"volume", [](auto& f) { f.volume_error = std::nan(""); }},
  };
  for (const auto& [word, plant] : faults) {
    SceneMeasures scene = sound_scene();
    plant(scene.frames[2]);
    EXPECT_THAT(sentences_of(scene), ElementsAre(testing::AllOf(HasSubstr(word), HasSubstr("frame 2")))) << word;
    EXPECT_THAT(worst_table({scene}), HasSubstr(" !1 ")) << word;
  }
}

TEST(SurfaceChecks, ManyIdsMayGoWithATopologyChangeAndDriftCountsAtTheEnd) {
  SceneMeasures scene = sound_scene();
  scene.frames[2].ids_kept = 0.91;
  scene.frames[2].change = true;
  scene.frames[2].material_drift = 5;
  EXPECT_THAT(sentences_of(scene), IsEmpty());
  scene.frames[3].material_drift = 1.01;
  EXPECT_THAT(sentences_of(scene), ElementsAre(HasSubstr("drift")));
}

TEST(SurfaceChecks, LostAreaIsToldButExcusesNoLostIds) {
  SceneMeasures scene = sound_scene();
  scene.frames[2].area_lost = 0.9;
  EXPECT_THAT(sentences_of(scene), IsEmpty());
  scene.frames[2].ids_kept = 0.94;
  EXPECT_THAT(sentences_of(scene), ElementsAre(HasSubstr("ids lost without")));
}

}  // namespace
}  // namespace flowskin::surfaces
