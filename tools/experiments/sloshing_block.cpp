#include "tools/experiments/sloshing_block.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "common/errors.h"
#include "common/quantile.h"
#include "scenes/io/atomic_file.h"
#include "scenes/scene.h"
#include "scenes/sources/make_source.h"
#include "tools/experiments/error_measures.h"
#include "tools/pipeline/tracker_bridge.h"

namespace flowskin::tools {
namespace {

constexpr double kRate = 24;       // files per second
constexpr int kStepsPerFrame = 4;  // of the true paths; with eight no error changes by 1e-6 spacings
constexpr double kPi = std::numbers::pi;

/// Made empty, and removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "flowskin_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw RunError("cannot make a temporary folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Block {
  double spacing;
  std::vector<Vec3> places;
};

/// A lattice jittered by 0.2 spacings at most along each axis.
Block make_block(int across) {
  Block block{1.0 / across, {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  for (int i = 0; i < 2 * across; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < across; ++k) {
        const double x = jitter(random), y = jitter(random), z = jitter(random);
        block.places.push_back(block.spacing * Vec3(i + 0.5 + x, j + 0.5 + y, k + 0.5 + z));
      }
  return block;
}

std::vector<Vec3> velocities_at(const std::vector<Vec3>& places, double time, double noise, int seed) {
  std::vector<Vec3> velocities;
  double squares = 0;
  for (const Vec3& place : places) {
    velocities.push_back(sloshing_velocity(place, time));
    squares += velocities.back().squaredNorm();
  }
  if (noise == 0) return velocities;
  std::mt19937 random(static_cast<unsigned>(seed) + 2);
  std::normal_distribution<double> gauss(0, noise * std::sqrt(squares / (3.0 * double(places.size()))));
  for (Vec3& velocity : velocities)
    for (int axis = 0; axis < 3; ++axis) velocity[axis] += gauss(random);
  return velocities;
}

void write_csv(const std::filesystem::path& file, const std::vector<Vec3>& places, double time, int number,
               const SloshingFiles& files) {
  std::string text = fmt::format("{}x,y,z{},time\n", files.ids ? "id," : "", files.velocities ? ",u,v,w" : "");
  const auto add = [&text](const std::string& cells) { text += cells; };
  const std::vector<Vec3> velocities = velocities_at(places, time, files.noise, number);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (files.ids) add(fmt::format("{},", i));
    add(fmt::format("{:.9g},{:.9g},{:.9g}", places[i].x(), places[i].y(), places[i].z()));
    if (files.velocities)
      add(fmt::format(",{:.9g},{:.9g},{:.9g}", velocities[i].x(), velocities[i].y(), velocities[i].z()));
    add(fmt::format(",{:.9g}\n", time));
  }
  scenes::write_file(file, text);
}

/// Writes the sequence. @return where the particles are at its end
std::vector<Vec3> write_sequence(const std::filesystem::path& folder, const Block& block, const SloshingFiles& files,
                                 int frames) {
  std::vector<Vec3> places = block.places;
  for (int frame = 0; frame <= frames; ++frame) {
    if (frame > 0)
      for (Vec3& place : places) place = sloshing_path(place, (frame - 1) / kRate, frame / kRate, kStepsPerFrame);
    if (frame % files.every == 0)
      write_csv(folder / fmt::format("block_{:04d}.csv", frame), places, frame / kRate, frame, files);
  }
  return places;
}

/// As `flowskin track` makes it: a step of the tracker for each file, unless the spacing is to be estimated.
scenes::Scene scene_of(const std::filesystem::path& folder, const std::string& method, const Block& block,
                       const SloshingFiles& files, const SloshingSettings& settings) {
  scenes::Scene scene;
  scene.frame_rate = kRate / files.every;
  scene.frames = settings.frames / files.every;
  scene.particles.source = scenes::ParticlesSpec::Source::recorded;
  scene.particles.spacing = block.spacing;
  scene.particles.recorded.files = {folder.string()};
  if (!files.ids) scene.particles.recorded.ids = scenes::RecordedSpec::Ids::none;
  scene.tracking.steps_per_frame = 1;
  scene.tracking.velocity = method;
  if (settings.fairing_iterations >= 0) scene.tracking.fairing_iterations = settings.fairing_iterations;
  return scene;
}

}  // namespace

Vec3 sloshing_velocity(const Vec3& place, double time) {
  constexpr double wave = 0.14, across = 0.06, along = 0.05, number = kPi / 2, frequency = 1.5;  // m/s, 1/m, 1/s
  const double x = place.x(), y = place.y(), z = place.z();
  const double swing = wave * std::cos(frequency * time) / std::sinh(number);
  return {-swing * std::cosh(number * y) * std::sin(number * x) + across * std::sin(kPi * x) * std::cos(kPi * y) +
              along * std::sin(kPi * x) * std::cos(kPi * z),
          swing * std::sinh(number * y) * std::cos(number * x) - across * std::cos(kPi * x) * std::sin(kPi * y),
          -along * std::cos(kPi * x) * std::sin(kPi * z)};
}

Vec3 sloshing_path(Vec3 place, double begin, double end, int steps) {
  const double step = (end - begin) / steps;
  for (int i = 0; i < steps; ++i) {
    const double time = begin + i * step;
    const Vec3 a = sloshing_velocity(place, time), b = sloshing_velocity(place + step / 2 * a, time + step / 2),
               c = sloshing_velocity(place + step / 2 * b, time + step / 2),
               d = sloshing_velocity(place + step * c, time + step);
    place += step / 6 * (a + 2 * b + 2 * c + d);
  }
  return place;
}

const std::vector<SloshingFiles>& sloshing_files() {
  static const std::vector<SloshingFiles> kinds{
      {"ids and velocities", true, true, 0, 1},         {"velocities, no ids", false, true, 0, 1},
      {"ids, no velocities", true, false, 0, 1},        {"positions only", false, false, 0, 1},
      {"2 % noise on velocities", true, true, 0.02, 1}, {"every second file", true, true, 0, 2}};
  return kinds;
}

SloshingErrors sloshing_errors(const std::string& method, const SloshingFiles& files,
                               const SloshingSettings& settings) {
  const TemporaryFolder folder;
  const Block block = make_block(settings.across);
  const std::vector<Vec3> at_end = write_sequence(folder.path(), block, files, settings.frames);
  const scenes::Scene scene = scene_of(folder.path(), method, block, files, settings);
  const auto source = scenes::make_source(scene);
  tracking::Tracker tracker(scenes::settings_in_metres(scene), to_particles(source->state()));
  for (int frame = 1; frame <= scene.frames; ++frame) {
    source->advance_to(frame / scene.frame_rate);
    tracker.advance(to_particles(source->state()));
  }

  const tracking::SurfaceMesh& mesh = tracker.mesh();
  const int steps = kStepsPerFrame * settings.frames;
  std::vector<double> errors(mesh.positions.size());
  for (std::size_t v = 0; v < errors.size(); ++v) {
    const Vec3 truth = sloshing_path(mesh.rest_positions[v], 0, settings.frames / kRate, steps);
    errors[v] = (truth - mesh.positions[v]).norm() / block.spacing;
  }
  return {quantile(errors, 0.5), quantile(errors, 0.9), distances(at_end, block.places).mean / block.spacing};
}

void put_sloshing_table(const SloshingSettings& settings, const std::function<void(const std::string&)>& put) {
  const std::size_t particles = make_block(settings.across).places.size();
  put(
      fmt::format("Sloshing block: {} particles, {} files, written and tracked as `flowskin track` does. Distance in "
                  "spacings between the\nvertices and where the flow takes their material, at the end: median (nine "
                  "tenths are nearer than).\n\n",
                  particles, settings.frames + 1));
  std::string head = "| method |", rule = "|---|";
  for (const SloshingFiles& files : sloshing_files()) {
    head += fmt::format(" {} |", files.name);
    rule += "---|";
  }
  put(head + "\n" + rule + "\n");
  double motion = 0;
  for (const auto& method : tracking::velocity_methods()) {
    std::string row = fmt::format("| {} |", method.name);
    for (const SloshingFiles& files : sloshing_files()) {
      const SloshingErrors errors = sloshing_errors(method.name, files, settings);
      row += fmt::format(" {:.3f} ({:.3f}) |", errors.median, errors.p90);
      motion = errors.motion;
    }
    put(row + "\n");
  }
  put(fmt::format("\nThe particles have moved by {:.2f} spacings on average.\n", motion));
}

}  // namespace flowskin::tools
