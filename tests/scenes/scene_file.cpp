// What a scene file means: defaults, comments, round trips, the shipped scenes, the documentation.
#include "scenes/scene_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "scene_file_helpers.h"
#include "scenes/nearest_name.h"
#include "scenes/settings_in_metres.h"

namespace flowskin::scenes::scene_file_test {
namespace {

std::string file_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "scenes")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  return files;
}

TEST(SceneFile, KeysThatAreNotThereKeepTheirDefaults) {
  const Scene scene = parse(small_scene());
  EXPECT_EQ(scene.frames, Scene{}.frames);
  EXPECT_EQ(scene.solver.viscosity, sph::SolverSettings{}.viscosity);
  EXPECT_EQ(scene.tracking.velocity, "auto");
  EXPECT_EQ(scene.solver.spacing, 0.1);
  EXPECT_EQ(scene.particles.spacing, 0.1);
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].body.shape, sph::FluidBody::Shape::ball);
  EXPECT_EQ(scene.bodies[0].body.center, Vec3(0, 1, 0));
  EXPECT_EQ(scene.bodies[0].body.radius, 0.5);
}

TEST(SceneFile, CommentsAreAllowed) {
  const Scene scene = parse(
      "// a scene\n{ /* many\n frames */ \"frames\": 7, \"particles\": {\"spacing\": 0.1}, // end\n"
      "\"emitters\": [{\"center\": [1, 2, 3], \"radius\": 1, \"speed\": 2}]}");
  EXPECT_EQ(scene.frames, 7);
  EXPECT_EQ(scene.emitters.at(0).emitter.center, Vec3(1, 2, 3));
}

// Every key of a simulated scene, none at its default.
const char* const full_scene = R"({
  "name": "full \"quoted\" \u00fc", "description": "d", "seed": 18446744073709551615, "frames": 7, "frame_rate": 24.1,
  "particles": {"source": "simulation", "spacing": 0.07},
  "fluid": {"density": 900.5, "viscosity": 0.3, "surface_tension": 0.04},
  "simulation": {"gravity": [0.1, -1.62, 1e-3], "kernel": "cubic_spline", "support_radius": 2.2, "max_speed": 3,
    "speed_of_sound": 31, "background_pressure": 7, "xsph": 0.2, "viscosity_form": "morris", "density_method": "continuity", "density_diffusion": 0.3, "particle_shifting": 0.6, "wall_drag": 0.7, "acoustic_cfl": 0.31, "viscous_cfl": 0.11,
    "force_cfl": 0.21, "max_time_step": 0.001, "capillary_cfl": 0.4, "viscosity_solver": "implicit", "viscosity_tolerance": 0.02, "viscosity_max_iterations": 77, "skin": 0.15, "domain": {"min": [-5, -5, -5], "max": [5, 6, 7]}, "periodic": [false, true, false]},
  "bodies": [
    {"shape": "block", "min": [0, 0, 0], "max": [1, 2, 3], "velocity": [1, 0, 0], "angular_velocity": [0, 1, 0]},
    {"shape": "ball", "center": [0, 3, 0], "radius": 0.3,
      "cuts": [{"min": [-0.1, 2, -1], "max": [0.1, 3, 1]}, {"min": [0.2, 2, -1], "max": [0.3, 3, 1]}]},
    {"shape": "mesh", "file": "meshes/stairs.obj", "scale": 2, "rotate": [10, 20, 30], "translate": [0.1, 0.2, 0.3]}],
  "emitters": [{"center": [0, 4, 0], "direction": [0, -2, 1], "radius": 0.2, "speed": 1.5, "start": 0.5, "stop": 2, "max_particles": 500}],
  "boundaries": [{"file": "meshes/stairs.obj", "adhesion": 0.3, "hollow": true, "scale": [1, 2, 3], "rotate": [0, 90, 0], "translate": [1, 0, 0],
    "slip": 0.4, "surface_velocity": [0.5, 0, 0.1], "interpolation": "smooth", "pivot": [0.1, 1, 0],
    "keyframes": [{"time": -0.5, "translate": [0, 1, 0], "rotate": [5, 0, 7]}, {"time": 2.5, "translate": [3, 0, 1], "rotate": [0, 400, 0]}], "visible": false, "color": [0.1, 0.2, 0.3]}],
  "tracking": {"enabled": false, "velocity": "total", "integrator": "rk4", "steps_per_frame": 3, "max_motion": 0.2,
    "radius": 2.1, "threshold": 0.7, "wall_share": 0.2, "edge_length": 0.9, "curvature_edges": 0.6, "smallest_part": 9.5, "small_parts": "balls", "fairing_iterations": 3, "fairing_stiffness": 0.4, "fairing_material": "dragged", "fairing_springs": "variable", "confidence": true, "remeshing": false, "max_slip": 2.5, "topology": false, "guard": false},
  "texture": {"image": "marble", "mapping": "planar", "tile_size": 0.3, "axis": [1, 0, 0], "rest_center": [0.1, 0, 0], "rest_size": 2,
    "when_stretched": "fade", "stretch_limit": 3.5},
  "render": {"enabled": false, "camera": {"position": [1, 2, 3], "look_at": [0, 0.5, 0], "up": [0, 0, 1],
    "vertical_fov": 40}, "width": 320, "height": 180, "samples": 2, "style": "solid", "ground": false,
    "ground_height": -1, "ground_color": [0.3, 0.2, 0.1], "light_direction": [1, 2, 3], "light_size": 5, "exposure": 1.5},
  "output": {"obj": false, "ply": false, "vtp": false, "particles": false, "video": false, "checks": "every", "checkpoint_interval": 3}
})";

TEST(SceneFile, WrittenScenesReadBackTheSame) {
  const Scene first = parse(full_scene);
  const std::string text = write_scene(first);
  // Read from elsewhere: file names must not depend on where the written scene stands.
  const Scene second = parse_scene(text, "copy.json", "/tmp");
  EXPECT_EQ(write_scene(second), text);
  EXPECT_EQ(second.seed, 18446744073709551615u);
  EXPECT_EQ(second.name, first.name);
  EXPECT_EQ(second.frame_rate, 24.1);
  EXPECT_EQ(second.solver.gravity, Vec3(0.1, -1.62, 1e-3));
  EXPECT_EQ(second.solver.kernel, sph::KernelType::cubic_spline);
  EXPECT_EQ(second.solver.domain.max, Vec3(5, 6, 7));
  ASSERT_EQ(second.bodies.size(), 3u);
  EXPECT_EQ(second.bodies[2].body.mesh.positions, first.bodies[2].body.mesh.positions);
  EXPECT_GT(second.bodies[2].body.mesh.triangles.size(), 10u);
  ASSERT_EQ(second.bodies[1].body.cuts.size(), 2u);
  EXPECT_EQ(second.bodies[1].body.cuts[1].min, Vec3(0.2, 2, -1));
  EXPECT_EQ(second.boundaries.at(0).boundary.mesh.positions, first.boundaries.at(0).boundary.mesh.positions);
  EXPECT_EQ(second.boundaries[0].boundary.slip, 0.4);
  EXPECT_FALSE(second.boundaries[0].visible);
  EXPECT_EQ(second.render.camera.up, Vec3(0, 0, 1));
}

TEST(SceneFile, EveryKeyReachesTheScene) {
  // Leaves out one line of the written scene at a time: it must then differ from the whole, so every key that is read
  // is kept somewhere and written again. Lines that only open or close a section, and required keys, stay.
  const std::string whole = write_scene(parse(full_scene));
  std::vector<std::string> lines;
  std::istringstream stream(whole);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  // Morris's form of the viscosity, which the scene has, knows no such laws; FluidsAndSinksReachTheScene looks at them.
  const std::array rheology{"consistency", "flow_index", "yield_stress", "regularization", "max_viscosity"};
  int dropped = 0;
  for (std::size_t skip = 0; skip < lines.size(); ++skip) {
    const bool is_leaf =
        lines[skip].find("\": ") != std::string::npos && lines[skip].find_last_of("{[") != lines[skip].size() - 1;
    const bool is_default =
        lines[skip].find("[0, 0, 0]") != std::string::npos ||
        lines[skip].find("\"simulation\",") != std::string::npos ||
        lines[skip].find("\"cuts\": []") != std::string::npos ||
        lines[skip].find("\"fluids\": []") != std::string::npos ||
        lines[skip].find("\"fluid\": \"\"") != std::string::npos ||
        lines[skip].find("\"sinks\": []") != std::string::npos ||
        std::any_of(rheology.begin(), rheology.end(),
                    [&](const char* name) { return lines[skip].find(name) != std::string::npos; }) ||
        lines[skip].find("\"shape\": \"disc\"") != std::string::npos;
    if (!is_leaf || is_default) continue;
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::string line = lines[i];
      if (i == skip) continue;
      const bool closes_next = i + 1 < lines.size() && lines[i + 1].find_first_not_of(" }],") == std::string::npos;
      const bool closes_after_gap = i + 1 == skip && lines[skip].back() != ',';
      if (closes_after_gap && !closes_next && line.back() == ',') line.pop_back();
      text += line + "\n";
    }
    try {
      EXPECT_NE(write_scene(parse(text)), whole) << lines[skip];
      ++dropped;
    } catch (const InputError& error) {
      EXPECT_THAT(std::string(error.what()),
                  testing::ContainsRegex("is missing|belongs to|set tracking.enabled to false"))
          << lines[skip];
    }
  }
  EXPECT_GT(dropped, 60);
}

TEST(SceneFile, PrescribedAndRecordedScenesReadBackTheSame) {
  for (
      const std::string particles :
      {R"({"source": "prescribed", "spacing": 0.1, "positions": [[0, 0, 0], [0.1, 0.2, 1e-17]],
            "motion": {"type": "rotation", "center": [1, 2, 3], "angular_velocity": [0, 0, 3.5], "velocity": [1, 0, 0]}})",
       R"({"source": "prescribed", "spacing": 0.1, "positions": [[0, 0, 0]], "motion": {"type": "vortex", "rate": 0.3}})",
       R"({"source": "prescribed", "spacing": 0.1, "positions": [[0, 0, 0]],
            "motion": {"type": "necking", "axis": [0, 1, 0], "rate": 0.3, "length": 2, "center": [1, 2, 3]}})",
       R"({"source": "prescribed", "spacing": 0.1, "positions": [[0, 0, 0]],
            "motion": {"type": "hole", "axis": [0, 1, 0], "period": 0.3, "length": 2, "center": [1, 2, 3]}})",
       R"({"source": "prescribed", "spacing": 0.1, "positions": [[0, 0, 0]],
            "motion": {"type": "deformation", "rate": 2, "period": 0.3}})",
       R"({"source": "recorded", "spacing": 0.1, "recorded": {"files": "run/f_*.ply", "frame_interval": 0.04}})"}) {
    const Scene first = parse("{\"particles\": " + particles + "}");
    const std::string text = write_scene(first);
    const Scene second = parse_scene(text, "copy.json", "/tmp");
    EXPECT_EQ(write_scene(second), text);
    EXPECT_EQ(second.particles.positions, first.particles.positions);
    EXPECT_EQ(second.particles.motion.type, first.particles.motion.type);
  }
}

TEST(SceneFile, EveryShippedSceneIsValidAndReadsBackTheSame) {
  const auto files = shipped_scenes();
  EXPECT_GE(files.size(), 7u);
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    const Scene scene = read_scene(file);
    const std::string text = write_scene(scene);
    EXPECT_EQ(write_scene(parse_scene(text, "copy.json", "/tmp")), text);
    EXPECT_FALSE(scene.description.empty());
  }
}

TEST(SceneFile, KeysAreDocumented) {
  const std::vector<SceneKey> keys = scene_keys();
  EXPECT_GT(keys.size(), 90u);
  std::set<std::string> paths;
  for (const SceneKey& key : keys) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " stands twice";
    EXPECT_FALSE(key.type.empty() || key.meaning.empty() || key.default_value.empty()) << key.path;
  }
  EXPECT_TRUE(paths.count("bodies[].radius") && paths.count("render.camera.vertical_fov"));
}

/// The table of docs/scenes.md.
std::string documented_table() {
  std::string table = "| Key | Type | Unit | Default | Meaning |\n|---|---|---|---|---|\n";
  for (const SceneKey& key : scene_keys()) {
    table += "| `" + key.path + "` | " + key.type + " | " + key.unit + " | `" + key.default_value + "` | " +
             key.meaning + " |\n";
  }
  return table;
}

TEST(SceneFile, FluidsAndSinksReachTheScene) {
  const Scene scene =
      parse(R"({"particles": {"spacing": 0.1}, "fluids": [{"name": "milk", "viscosity": 0.002}, {"name": "honey",
    "viscosity": 0.02, "rheology": {"consistency": 2, "flow_index": 0.7, "yield_stress": 3, "regularization": 50,
    "max_viscosity": 4}}], "bodies": [{"shape": "ball", "center": [0, 1, 0], "radius": 0.5, "fluid": "honey"}],
    "sinks": [{"shape": "ball", "center": [1, 2, 3], "radius": 0.25, "start": 0.5, "stop": 2}]})");
  const Scene again = parse(write_scene(scene));
  ASSERT_EQ(again.fluids.size(), 2U);
  EXPECT_EQ(again.fluids[1].name, "honey");
  EXPECT_EQ(again.fluids[1].viscosity, 0.02);
  const sph::Rheology& law = again.fluids[1].rheology;
  EXPECT_EQ(law.consistency, 2);
  EXPECT_EQ(law.flow_index, 0.7);
  EXPECT_EQ(law.yield_stress, 3);
  EXPECT_EQ(law.regularization, 50);
  EXPECT_EQ(law.max_viscosity, 4);
  EXPECT_EQ(again.bodies.at(0).body.fluid, "honey");
  ASSERT_EQ(again.sinks.size(), 1U);
  EXPECT_EQ(write_scene(again), write_scene(scene));
}

/// Each word of the file reaches the tracker, and lengths are metres there.
TEST(SceneFile, TrackingKeysReachTheTrackersSettings) {
  const auto settings_of = [](const std::string& keys) {
    return settings_in_metres(parse(small_scene("\"tracking\": {" + keys + "}")));
  };
  using tracking::Integrator;
  using tracking::SmallParts;
  const std::vector<std::pair<std::string, Integrator>> integrators{
      {"euler", Integrator::euler}, {"rk2", Integrator::rk2}, {"rk4", Integrator::rk4}};
  for (const auto& [name, value] : integrators) {
    EXPECT_EQ(settings_of("\"integrator\": \"" + name + "\"").integrator, value);
    EXPECT_EQ(name_of(tracking::kIntegratorNames, value), name);
  }
  const std::vector<std::pair<std::string, SmallParts>> parts{
      {"keep", SmallParts::keep}, {"drop", SmallParts::drop}, {"balls", SmallParts::balls}};
  for (const auto& [name, value] : parts)
    EXPECT_EQ(settings_of("\"small_parts\": \"" + name + "\"").small_parts, value);
  EXPECT_TRUE(settings_of(R"("fairing_springs": "variable")").variable_springs);
  EXPECT_FALSE(settings_of(R"("fairing_springs": "constant")").variable_springs);
  const tracking::TrackerSettings settings =
      settings_of(R"("radius": 3, "edge_length": 0.5, "smallest_part": 8, "max_slip": 2, "threshold": 7)");
  EXPECT_EQ(settings.spacing, 0.1);
  EXPECT_DOUBLE_EQ(settings.field.radius, 0.3);
  EXPECT_EQ(settings.field.threshold, 7);
  EXPECT_DOUBLE_EQ(settings.edge_length, 0.05);
  EXPECT_DOUBLE_EQ(settings.smallest_part, 0.008);
  EXPECT_DOUBLE_EQ(settings.max_slip, 0.2);
  EXPECT_TRUE(settings_of(R"("velocity": "hybrid", "fairing_material": "dragged")").fairing_drags);
  EXPECT_FALSE(settings_of(R"("velocity": "curvature", "fairing_material": "kept")").fairing_drags);
  for (const char* name : {"auto", "hybrid", "simulation", "affine"})
    EXPECT_FALSE(settings_of(fmt::format(R"("velocity": "{}")", name)).fairing_drags) << name;
  for (const char* name : {"normal", "total", "curvature", "curvature-belyaev", "rigid", "rigid-global"})
    EXPECT_TRUE(settings_of(fmt::format(R"("velocity": "{}")", name)).fairing_drags) << name;
  EXPECT_EQ(settings_of("").velocity, "hybrid");
  EXPECT_EQ(settings_of("").max_slip, 0);
}

TEST(SceneFile, TheDocumentedTableIsTheProgramsOwn) {
  const std::string docs = file_text(source_folder() / "docs" / "scenes.md");
  if (docs.find(documented_table()) != std::string::npos) return;
  const auto wanted = std::filesystem::path(testing::TempDir()) / "flowskin_scene_keys.md";
  std::ofstream(wanted) << documented_table();
  ADD_FAILURE() << "the table of keys in docs/scenes.md is not that of scene_keys(); put in the one of " << wanted;
}

TEST(SceneFile, RandomMutationsNeverCrash) {
  const std::string letters = "{}[]\",:0123456789.eE-+ \n/*abcxyz_\\\x01\xff";
  std::mt19937_64 random(20130201);
  int parsed = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = i % 2 == 0 ? full_scene : small_scene();
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < changes; ++k) {
      const std::size_t place = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[place] = letters[random() % letters.size()];
          break;
        case 1:
          text.erase(place, 1 + random() % 8);
          break;
        case 2:
          text.insert(place, 1, letters[random() % letters.size()]);
          break;
        default:
          text.insert(place, text.substr(random() % text.size(), random() % 20));
      }
      if (text.empty()) text = " ";
    }
    try {
      const Scene scene = parse(text);
      ++parsed;
      EXPECT_NO_THROW(parse(write_scene(scene))) << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("test.json:")) << text;
    }
  }
  EXPECT_GT(parsed, 20);
}

TEST(NearestName, FindsWhatWasMeant) {
  EXPECT_EQ(edit_distance("viscosity", "viscosty"), 1);
  EXPECT_EQ(edit_distance("ab", "ba"), 1);
  EXPECT_EQ(edit_distance("maxTimeStep", "max_time_step"), 0);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(nearest_name("radus", {"shape", "radius", "center"}), "radius");
  EXPECT_EQ(nearest_name("colour", {"color", "slip"}), "color");
  EXPECT_EQ(nearest_name("zzz", {"shape", "radius"}), "");
}

}  // namespace
}  // namespace flowskin::scenes::scene_file_test
