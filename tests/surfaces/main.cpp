// The tests of this folder, and without them the table of any scenes:
//   tests_surfaces [GTEST OPTIONS]
//   tests_surfaces --table [--frames N] [--every-frame] [SCENE.json...]     default: the scenes of the tests
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "surfaces/dense_distance.h"
#include "surfaces/scene_list.h"
#include "surfaces/surface_checks.h"

namespace {

int print_table(const std::vector<std::string>& arguments) {
  using namespace flowskin::surfaces;
  std::vector<std::filesystem::path> files;
  int most_frames = 0;
  bool every_frame = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--frames" && i + 1 < arguments.size()) {
      most_frames = std::atoi(arguments[++i].c_str());
    } else if (arguments[i] == "--every-frame") {
      every_frame = true;
    } else {
      files.emplace_back(arguments[i]);
    }
  }
  if (files.empty()) files = tested_scenes();
  std::vector<SceneMeasures> scenes;
  for (const auto& file : files) {
    scenes.push_back(measure_scene(file, most_frames, [&](const SceneMeasures& so_far) {
      if (every_frame) std::printf("%s", frame_line(so_far).c_str());
      std::fflush(stdout);
    }));
    for (const auto& violation : violations(scenes.back())) std::printf("%s\n", violation.sentence.c_str());
    std::fflush(stdout);
  }
  std::printf("\nHausdorff: %d random points a triangle, seed %llu\n", kSamplesPerTriangle,
              static_cast<unsigned long long>(kSampleSeed));
  std::printf("%s\n%s", worst_table(scenes).c_str(), return_table(scenes).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--table") {
    try {
      return print_table({argv + 2, argv + argc});
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return 2;
    }
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
