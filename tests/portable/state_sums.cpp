// Sums of the particles' positions and velocities after each frame of a scene, to compare compilers, machines and
// numbers of threads: the same lines, or not the same results. Usage: state_sums SCENE FRAMES THREADS...
#include <fmt/format.h>
#include <omp.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "scenes/io/checksum.h"
#include "scenes/scene_file.h"
#include "scenes/sources/make_source.h"

namespace {

using namespace flowskin;

template <class Vector>
std::uint32_t sum_of(const std::vector<Vector>& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return scenes::checksum(0, std::string_view(bytes, values.size() * sizeof(Vector)));
}

std::string line(int frame, const scenes::ParticleState& state) {
  return fmt::format("{} {} {:08x} {:08x}", frame, state.positions.size(), sum_of(state.positions),
                     sum_of(state.velocities));
}

std::vector<std::string> lines_of(const scenes::Scene& scene, int frames, int threads) {
  omp_set_num_threads(threads);
  const auto source = scenes::make_source(scene);
  std::vector<std::string> lines{line(0, source->state())};
  for (int frame = 1; frame <= frames; ++frame) {
    source->advance_to(frame / scene.frame_rate);
    lines.push_back(line(frame, source->state()));
  }
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "Usage: state_sums SCENE FRAMES THREADS...\n");
    return 2;
  }
  const scenes::Scene scene = scenes::read_scene(argv[1]);
  std::vector<std::string> first;
  for (int k = 3; k < argc; ++k) {
    const std::vector<std::string> lines = lines_of(scene, std::atoi(argv[2]), std::atoi(argv[k]));
    if (first.empty()) first = lines;
    if (lines == first) continue;
    fmt::print(stderr, "state_sums: {} and {} threads give different results\n", argv[3], argv[k]);
    return 1;
  }
  fmt::print("frame, particles, sum of positions, of velocities\n");
  for (const std::string& text : first) fmt::print("{}\n", text);
  return 0;
}
