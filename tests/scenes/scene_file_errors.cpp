// Every kind of mistake in a scene file, with the parts that its message must have.
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <type_traits>

#include "scene_file_helpers.h"

namespace flowskin::scenes::scene_file_errors_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(SceneFileErrors, MissingFileFolderAndUnreadableFile) {
  const auto message = [](const std::filesystem::path& file) {
    try {
      read_scene(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message("/nowhere/at_all.json"),
              AllOf(StartsWith("/nowhere/at_all.json"), HasSubstr("no such scene file")));
  EXPECT_THAT(message(source_folder()), AllOf(HasSubstr("folder"), HasSubstr("expected a scene file")));
  const auto file = std::filesystem::path(testing::TempDir()) / "flowskin_unreadable.json";
  std::ofstream(file) << small_scene();
  std::filesystem::permissions(file, std::filesystem::perms::none);
  // Whoever runs the tests as root can read everything.
  if (!std::ifstream(file).is_open()) {
    EXPECT_THAT(message(file), HasSubstr("cannot be read"));
  }
  std::filesystem::remove(file);
}

TEST(SceneFileErrors, Syntax) {
  EXPECT_THAT(error_of(""), AllOf(StartsWith("test.json:1:1"), HasSubstr("not valid JSON")));
  EXPECT_THAT(error_of("{\n  \"frames\": 3,\n}"), AllOf(StartsWith("test.json:3:1"), HasSubstr("comma too many")));
  EXPECT_THAT(error_of("{\n  \"frames\": 3\n  \"seed\": 1}"),
              AllOf(StartsWith("test.json:3:3"), HasSubstr("comma missing")));
  EXPECT_THAT(error_of("{\"frames\": 3"), HasSubstr("closing brace"));
  EXPECT_THAT(error_of("{'frames': 3}"), AllOf(StartsWith("test.json:1:2"), HasSubstr("double quotes")));
  EXPECT_THAT(error_of("{\"name\": \"\xff\"}"), HasSubstr("UTF-8"));
  EXPECT_THAT(error_of(std::string(100000, '[')), HasSubstr("nested"));
}

TEST(SceneFileErrors, UnknownKeysNameTheNearest) {
  EXPECT_THAT(
      error_of(small_scene(R"("fluid": {"viscosty": 0.1})")),
      AllOf(StartsWith("test.json:4:13: "), HasSubstr("fluid.viscosty"), HasSubstr("did you mean \"viscosity\"?")));
  EXPECT_THAT(error_of(small_scene(R"("frameRate": 30)")),
              AllOf(StartsWith("test.json:4:3: "), HasSubstr("did you mean \"frame_rate\"?")));
  // A key in the wrong section: the right place is named.
  EXPECT_THAT(error_of(small_scene(R"("viscosity": 0.1)")), HasSubstr("did you mean \"fluid.viscosity\"?"));
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"qqqqq": 0.1})")), HasSubstr("valid here: density, viscosity"));
  EXPECT_THAT(error_of(small_scene(R"("emitters": [{"center": [0,0,0], "radius": 1, "sped": 1}])")),
              AllOf(HasSubstr("emitters[0].sped"), HasSubstr("did you mean \"speed\"?"),
                    HasSubstr("emitters[0].speed is missing")));
}

TEST(SceneFileErrors, WrongTypes) {
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"viscosity": "thick"})")),
              AllOf(StartsWith("test.json:4:13: fluid.viscosity"), HasSubstr("the text \"thick\""),
                    HasSubstr("number >= 0 (m^2/s)")));
  EXPECT_THAT(error_of(small_scene(R"("frames": 2.5)")), AllOf(HasSubstr("2.5"), HasSubstr("whole number")));
  EXPECT_THAT(error_of(small_scene(R"("name": 3)")), HasSubstr("expected text"));
  EXPECT_THAT(error_of(small_scene(R"("seed": -1)")), HasSubstr("seed is the number -1"));
  EXPECT_THAT(error_of(small_scene(R"("output": {"obj": 1})")), HasSubstr("true or false"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"gravity": [0, -9.81]})")),
              AllOf(HasSubstr("a list of 2"), HasSubstr("3 numbers (m/s^2)")));
  EXPECT_THAT(error_of(small_scene("\"simulation\": {\"gravity\": [0,\n \"g\", 0]}")),
              AllOf(StartsWith("test.json:5:2"), HasSubstr("\"g\"")));
  EXPECT_THAT(error_of(small_scene(R"("fluid": 3)")), AllOf(HasSubstr("fluid is the number 3"), HasSubstr("object")));
  EXPECT_THAT(error_of(small_scene(R"("emitters": {})")), HasSubstr("expected list of objects"));
  EXPECT_THAT(error_of(small_scene(R"("emitters": [3])")), HasSubstr("emitters[0] is the number 3"));
  EXPECT_THAT(error_of(small_scene(R"("frame_rate": null)")), HasSubstr("null"));
  EXPECT_THAT(error_of("[]"), HasSubstr("the scene is a list"));
}

TEST(SceneFileErrors, NumbersOutOfRange) {
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"density": 1e999})")),
              AllOf(StartsWith("test.json:4:24"), HasSubstr("1e999"), HasSubstr("too large")));
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"viscosity": -1})")),
              AllOf(HasSubstr("the number -1"), HasSubstr("number >= 0 (m^2/s)")));
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"density": 1e300})")), HasSubstr("the largest allowed"));
  EXPECT_THAT(error_of(small_scene(R"("frames": -1)")),
              AllOf(HasSubstr("frames is the number -1"), HasSubstr("from 0 to")));
  EXPECT_THAT(error_of(small_scene(R"("frames": 1e99)")), HasSubstr("frames"));
  EXPECT_THAT(error_of(small_scene(R"("render": {"ground_color": [0, 0, 2]})")), HasSubstr("from 0 to 1"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"support_radius": 0.5})")), HasSubstr("from 1.5 to 4 (spacings)"));
}

TEST(SceneFileErrors, MissingRequiredKeys) {
  EXPECT_THAT(error_of("{}"), AllOf(HasSubstr("particles.spacing is missing"), HasSubstr("(m)")));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1}})"), HasSubstr("nothing to simulate"));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1}, "bodies": []})"),
              AllOf(StartsWith("test.json:1:33"), HasSubstr("nothing to simulate")));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1}, "bodies": [{}]})"),
              HasSubstr("bodies[0].shape is missing; expected one of: block, ball, mesh"));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1}, "bodies": [{"shape": "ball", "center": [0,0,0]}]})"),
              HasSubstr("bodies[0].radius is missing"));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1, "source": "recorded"}})"),
              HasSubstr("particles.recorded.files is missing"));
}

TEST(SceneFileErrors, KeysThatStandTwice) {
  EXPECT_THAT(error_of(small_scene(R"("frames": 3, "frames": 4)")),
              AllOf(StartsWith("test.json:4:16"), HasSubstr("frames stands here a second time")));
  EXPECT_THAT(error_of(small_scene(R"("fluid": {"density": 3, "density": 3})")),
              HasSubstr("fluid.density stands here a second time"));
  EXPECT_THAT(error_of(small_scene(R"("fluid": {}, "fluid": {})")), HasSubstr("fluid stands here a second time"));
}

TEST(SceneFileErrors, WrongNames) {
  EXPECT_THAT(
      error_of(small_scene(R"("tracking": {"velocity": "curvatur"})")),
      AllOf(HasSubstr("tracking.velocity"), HasSubstr("did you mean \"curvature\"?"), HasSubstr("curvature-belyaev")));
  EXPECT_THAT(error_of(small_scene(R"("texture": {"mapping": "boxx"})")), HasSubstr("did you mean \"box\"?"));
  EXPECT_THAT(error_of(small_scene(R"("texture": {"when_stretched": "fad"})")), HasSubstr("did you mean \"fade\"?"));
  EXPECT_THAT(error_of(small_scene(R"("texture": {"stretch_limit": 1})")), HasSubstr("texture.stretch_limit"));
  EXPECT_THAT(error_of(small_scene(R"("texture": {"stretch_limit": "four"})")), HasSubstr("texture.stretch_limit"));
  EXPECT_THAT(error_of(R"({"particles": {"source": "simulaton", "spacing": 0.1}, "bodies": []})"),
              HasSubstr("did you mean \"simulation\"?"));
}

/// Settings that are words are enumerations from here on: a misspelt one is refused and never becomes a default.
TEST(SceneFileErrors, MisspeltWordsNameTheNearest) {
  const std::vector<std::array<std::string, 3>> cases{
      {"tracking", R"("integrator": "rk3")", "did you mean \"rk2\"?"},
      {"tracking", R"("small_parts": "bals")", "did you mean \"balls\"?"},
      {"tracking", R"("fairing_springs": "variabel")", "did you mean \"variable\"?"},
      {"simulation", R"("density_method": "sumation")", "did you mean \"summation\"?"},
      {"simulation", R"("viscosity_form": "moris")", "did you mean \"morris\"?"},
      {"simulation", R"("viscosity_solver": "implict")", "did you mean \"implicit\"?"},
      {"simulation", R"("kernel": "wendland")", "expected one of: wendland_c2, cubic_spline"},
  };
  for (const auto& [section, key, answer] : cases)
    EXPECT_THAT(error_of(small_scene("\"" + section + "\": {" + key + "}")), HasSubstr(answer)) << key;
  static_assert(std::is_enum_v<decltype(TrackingSpec::integrator)> &&
                std::is_enum_v<decltype(TrackingSpec::small_parts)>);
  static_assert(std::is_enum_v<decltype(RecordedSpec::ids)>);
}

/// A value without a name, which only a program can set, is not written as if it were the default.
TEST(SceneFileErrors, ValuesWithoutANameAreNotWritten) {
  Scene scene = parse(small_scene());
  scene.tracking.integrator = static_cast<tracking::Integrator>(7);
  EXPECT_THROW(write_scene(scene), std::logic_error);
}

TEST(SceneFileErrors, KeysOfAnotherKindOfObject) {
  EXPECT_THAT(
      error_of(
          R"({"particles": {"spacing": 0.1}, "bodies": [{"shape": "block", "min": [0,0,0], "max": [1,1,1], "radius": 1}]})"),
      HasSubstr("bodies[0].radius belongs to shape \"ball\" only"));
  EXPECT_THAT(error_of(small_scene(R"("particles_": 1)")), HasSubstr("particles_"));
  EXPECT_THAT(error_of(R"({"particles": {"spacing": 0.1, "jitter": 0.1}, "bodies": []})"),
              HasSubstr("belongs to particles.source \"prescribed\" only"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"density_diffusion": 0.1})")),
              HasSubstr("belongs to simulation.density_method \"continuity\" only"));
  // One wrong shape must not make an error of each of its keys.
  const std::string message =
      error_of(R"({"particles": {"spacing": 0.1}, "bodies": [{"shape": "bal", "center": [0,0,0], "radius": 1}]})");
  EXPECT_THAT(message, AllOf(HasSubstr("did you mean \"ball\"?"), Not(HasSubstr("\n"))));
}

TEST(SceneFileErrors, Contradictions) {
  EXPECT_THAT(
      error_of(R"({"particles": {"spacing": 0.1}, "bodies": [{"shape": "block", "min": [0,0,0], "max": [1,-1,1]}]})"),
      HasSubstr("bodies[0].min must be smaller"));
  EXPECT_THAT(
      error_of(
          R"({"particles": {"spacing": 0.1}, "bodies": [{"shape": "ball", "center": [0,0,0], "radius": 1, "cuts": [{"min": [0,0,0], "max": [1,0,1]}]}]})"),
      HasSubstr("bodies[0].cuts has an entry 0 whose min is not smaller"));
  EXPECT_THAT(
      error_of(
          R"({"particles": {"source": "prescribed", "spacing": 0.1, "positions": [[0,0,0]], "motion": {"type": "hole", "axis": [0, 0, 0]}}})"),
      HasSubstr("particles.motion.axis is zero"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"domain": {"min": [0,0,0], "max": [1,-1,1]}})")),
              HasSubstr("simulation.domain.min must not be greater"));
  EXPECT_THAT(error_of(small_scene(R"("boundaries": [{"file": "meshes/stairs.obj",
                                        "keyframes": [{"time": 1}, {"time": 1}]}])")),
              HasSubstr("boundaries[0].keyframes has an entry 1 whose time is not later"));
  EXPECT_THAT(error_of(small_scene(R"("boundaries": [{"file": "meshes/stairs.obj", "keyframes": [{}]}])")),
              HasSubstr("boundaries[0].keyframes[0].time is missing"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"periodic": [true, false]})")),
              HasSubstr("simulation.periodic is a list of 2; expected 3 times true or false"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"periodic": [true, false, false]},
                                      "tracking": {"enabled": false})")),
              HasSubstr("simulation.periodic is true for x, where simulation.domain is 0 m long"));
  EXPECT_THAT(
      error_of(small_scene(R"("simulation": {"domain": {"max": [50, 0, 0]}, "periodic": [true, false, false]})")),
      HasSubstr("set tracking.enabled to false"));
  EXPECT_THAT(error_of(small_scene(R"("render": {"camera": {"position": [1,1,1], "look_at": [1,1,1]}})")),
              AllOf(StartsWith("test.json:4:46"), HasSubstr("same point")));
  EXPECT_THAT(error_of(small_scene(R"("render": {"camera": {"position": [0,5,0], "look_at": [0,1,0]}})")),
              HasSubstr("render.camera.up"));
  EXPECT_THAT(error_of(small_scene(R"("simulation": {"max_speed": 5, "speed_of_sound": 3})")),
              HasSubstr("larger than simulation.max_speed"));
  EXPECT_THAT(
      error_of(small_scene(R"("emitters": [{"center": [0,0,0], "radius": 1, "speed": 1, "start": 2, "stop": 1}])")),
      HasSubstr("emitters[0].stop must be later"));
  EXPECT_THAT(
      error_of(
          R"({"particles": {"source": "prescribed", "spacing": 0.1, "positions": [[0,0,0]]}, "bodies": [{"shape": "ball", "center": [0,0,0], "radius": 1}]})"),
      HasSubstr("both given"));
  EXPECT_THAT(
      error_of(
          R"({"particles": {"source": "prescribed", "spacing": 0.1}, "bodies": [{"shape": "ball", "center": [0,0,0], "radius": 1, "velocity": [1,0,0]}]})"),
      HasSubstr("bodies[0].velocity has no meaning"));
  EXPECT_THAT(
      error_of(R"({"particles": {"spacing": 1e-6}, "bodies": [{"shape": "ball", "center": [0,0,0], "radius": 1}]})"),
      HasSubstr("more than 1e+08 particles"));
}

TEST(SceneFileErrors, MissingFiles) {
  EXPECT_THAT(error_of(small_scene(R"("boundaries": [{"file": "meshes/stars.obj"}])")),
              AllOf(StartsWith("test.json:4:19: boundaries[0].file"), HasSubstr("meshes/stars.obj"),
                    HasSubstr("did you mean \"stairs.obj\"?")));
  EXPECT_THAT(error_of(small_scene(R"("texture": {"image": "cheker"})")), HasSubstr("did you mean \"checker\"?"));
  EXPECT_THAT(error_of(small_scene(R"("boundaries": [{"file": "meshes"}])")),
              HasSubstr("boundaries[0].file cannot be read"));
  EXPECT_THAT(error_of(small_scene(R"("boundaries": [{"file": "a.obj", "scale": [1, 0, 1]}])")), HasSubstr("flattens"));
}

TEST(SceneFileErrors, AllProblemsAreListedInOrder) {
  const std::string message =
      error_of("{\n\"frames\": -1,\n\"particles\": {\"spacing\": 0},\n\"seed\": \"x\",\n\"nam\": 1}");
  EXPECT_THAT(message, testing::ContainsRegex("test.json:2:1.*\ntest.json:3:15.*\ntest.json:4:1.*\ntest.json:5:1"));
}

}  // namespace
}  // namespace flowskin::scenes::scene_file_errors_test
