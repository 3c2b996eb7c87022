// flowskin track PARTICLES...: a tracked surface on anyone's particles, by way of a scene made from the options.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/bounds.h"
#include "common/errors.h"
#include "common/outliers.h"
#include "scenes/scene_checks.h"
#include "scenes/scene_file.h"
#include "scenes/sources/particle_sequence.h"
#include "scenes/sources/particle_spacing.h"
#include "tools/commands/shared_options.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/run_scene.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/render/camera.h"
#include "tools/report/messages.h"

namespace flowskin::tools {

namespace {

namespace fs = std::filesystem;
using scenes::ParticleSequence;
using scenes::Vec3;

/// What the user says; lengths in metres. Unset values are estimated or have defaults.
struct TrackOptions {
  std::vector<fs::path> particles;  ///< files, patterns, a folder, one file of many steps, or one .pvd
  std::optional<double> spacing, radius, edge_length, tile_size;
  std::optional<double> frame_rate, time_step;  ///< files per second, s between files
  bool no_ids = false, times_in_names = false;
  std::optional<std::string> keep;  ///< expression of columns
  std::vector<double> region;       ///< two corners (m); empty: all
  bool skip_invalid = false, skip_duplicates = false;
  bool list = false;             ///< only say which files are read, in which order and at which times
  std::string texture, mapping;  ///< empty: the scene file's defaults
  std::string up = "y";          ///< or z
  RunOptions run;                ///< without scene_file
  PictureFlags pictures;
};

/// A radius in the files is believed where the spacing by it is within this factor of the distances found.
constexpr double kLargestDisagreement = 2;

void tell(const TrackOptions& options, const std::string& line) {
  if (!options.run.quiet) say_line(line);
}

void warn(const std::string& line) { say_line("warning: " + line); }

/// Particles that tell the spacing: those of the first file, or of a later one that has more than twice as many, since
/// emitters begin with a layer or less.
std::vector<Vec3> telling_positions(const ParticleSequence& sequence) {
  constexpr std::size_t looks = 5;
  std::vector<Vec3> most = sequence.first.state.positions;
  const std::size_t first = most.size(), last = sequence.places.size() - 1;
  const auto look_at = [&](std::size_t k) {
    std::vector<Vec3> positions = scenes::read_sequence_file(sequence, k).state.positions;
    if (positions.size() > most.size() && positions.size() > 2 * first) most = std::move(positions);
  };
  for (std::size_t look = 1; look < looks && last > 0; ++look) look_at(look * last / (looks - 1));
  for (std::size_t k = 1; k <= last && most.size() < 2; ++k) look_at(k);
  return most;
}

/// What the spacing was found by, and what is odd about the particles.
void tell_estimate(const TrackOptions& options, const scenes::SpacingEstimate& estimate, std::size_t particles) {
  tell(options, fmt::format("spacing: {:.4g} m, estimated: {}, to within some {:.0f} % (--spacing settles it)",
                            estimate.spacing, estimate.method, 100 * estimate.uncertainty));
  if (estimate.coincident > 0)
    warn(fmt::format("{} of {} particles are in places that others have, too; --skip-duplicates leaves them out",
                     estimate.coincident, particles));
  if (estimate.dimensions < 3)
    warn(
        fmt::format("all particles lie in a {}: these are data in {} dimension{}. One layer of particles has no "
                    "surface; repeat the "
                    "particles in several layers, {:.4g} m apart",
                    estimate.dimensions == 2 ? "plane" : "line", estimate.dimensions,
                    estimate.dimensions == 2 ? "s" : "", estimate.spacing));
}

/// Spacing as given, from the radius in the files, or from the distances in the file that says most.
double spacing_of(const TrackOptions& options, const ParticleSequence& sequence) {
  if (options.spacing) return *options.spacing;
  const std::vector<Vec3> positions = telling_positions(sequence);
  const scenes::SpacingEstimate found = scenes::estimate_spacing(positions);
  const double estimate = found.spacing;
  const double by_radius = 2 * sequence.first.radius;
  const bool agree =
      estimate > 0 && by_radius < kLargestDisagreement * estimate && estimate < kLargestDisagreement * by_radius;
  if (by_radius > 0 && (agree || !(estimate > 0))) {
    tell(options, fmt::format("spacing: {:.4g} m, twice the radius in the files", by_radius));
    return by_radius;
  }
  if (!(estimate > 0))
    throw InputError(
        "the spacing of the particles cannot be estimated: fewer than two are apart in all files; give "
        "--spacing");
  if (by_radius > 0)
    warn(fmt::format("the files say radius {:.4g} m, but neighbours are {:.4g} m apart: --spacing settles it",
                     by_radius / 2, estimate));
  tell_estimate(options, found, positions.size());
  return estimate;
}

/// "track_" and what the files are called, without their number; the folder's name where that says nothing.
std::string default_name(const fs::path& first) {
  const auto without_number = [](std::string name) {
    const std::size_t end = name.find_last_not_of("0123456789_-. ");
    return end == std::string::npos ? std::string() : name.substr(0, end + 1);
  };
  std::string name = without_number(first.stem().string());
  std::error_code no_current_folder;
  fs::path folder = fs::absolute(first, no_current_folder).parent_path();
  for (; (name.empty() || name == "frame" || name == "particles") && folder.has_relative_path();
       folder = folder.parent_path())
    name = without_number(folder.filename().string()).empty() ? "" : folder.filename().string();
  return "track_" + (name.empty() ? "particles" : name);
}

void set_times(const TrackOptions& options, ParticleSequence& sequence, scenes::Scene& scene) {
  scene.frame_rate = 1 / sequence.interval;
  const double all = std::floor(sequence.times.back() / sequence.interval + 1e-6);
  if (all > 1e6)
    throw InputError(
        fmt::format("the files span {:.4g} s at {:.4g} s per frame: more than a million frames; is "
                    "--time-step right?",
                    sequence.times.back(), sequence.interval));
  scene.frames = static_cast<int>(all);
  if (options.run.frames) scene.frames = std::min(scene.frames, *options.run.frames);
}

/// Particles at the beginning, in the middle and at the end: what pictures are to show.
std::vector<Vec3> places_seen(const ParticleSequence& sequence) {
  std::vector<Vec3> places;
  const std::size_t last = sequence.places.size() - 1;
  for (const std::size_t k : {std::size_t{0}, last / 2, last}) {
    const std::vector<Vec3> positions = scenes::read_sequence_file(sequence, k).state.positions;
    places.insert(places.end(), positions.begin(), positions.end());
  }
  return places;
}

/// What pictures need not show is said.
std::vector<Vec3> places_shown(const ParticleSequence& sequence, double spacing) {
  const std::vector<Vec3> places = places_seen(sequence);
  std::vector<Vec3> shown = without_outliers(places, kPictureMargin * spacing);
  if (shown.size() < places.size())
    warn(fmt::format(
        "{} of {} particles (at the start, in the middle and at the end) are so far out that pictures leave "
        "them out; --region leaves particles out altogether",
        places.size() - shown.size(), places.size()));
  return shown;
}

void set_pictures(const TrackOptions& options, const ParticleSequence& sequence, scenes::Scene& scene) {
  const std::vector<Vec3> places = places_shown(sequence, scene.particles.spacing);
  if (options.up == "z") {
    scene.render.camera.up = {0, 0, 1};
    scene.texture.axis = {0, 0, 1};
    scene.render.light_direction = {-0.4, -0.5, 1.0};
    scene.render.ground = false;
  } else {
    scene.render.ground_height = bounds(places).min.y() - scene.particles.spacing / 2;
  }
  const double aspect = static_cast<double>(scene.render.width) / scene.render.height;
  if (!places.empty()) scene.render.camera = place_camera(scene.render.camera, aspect, places);
}

/// Infinite numbers stand for no bound.
std::vector<Vec3> corners(std::vector<double> numbers) {
  constexpr double kNoBound = 1e9;  // m, as far as particles may be
  for (double& number : numbers) {
    if (std::isnan(number))
      throw InputError("--region: nan is no coordinate; expected XMIN YMIN ZMIN XMAX YMAX ZMAX (m)");
    if (std::isinf(number)) number = std::copysign(kNoBound, number);
  }
  const Vec3 a(numbers[0], numbers[1], numbers[2]), b(numbers[3], numbers[4], numbers[5]);
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

/// The part of the scene that says which files are played, and how.
scenes::RecordedSpec recorded_spec(const TrackOptions& options) {
  scenes::RecordedSpec spec;
  for (const fs::path& file : options.particles) spec.files.push_back(file.string());
  if (options.time_step) spec.frame_interval = *options.time_step;
  if (options.frame_rate) spec.frame_interval = 1 / *options.frame_rate;
  spec.times_in_names = options.times_in_names;
  if (options.keep) spec.keep = *options.keep;
  if (options.keep && options.keep->find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError("--keep is empty; expected what particles are to fulfil, such as 'Type == 1 and z > 0.5'");
  if (!options.region.empty()) spec.region = corners(options.region);
  spec.skip_invalid = options.skip_invalid;
  spec.skip_duplicates = options.skip_duplicates;
  if (options.no_ids) spec.ids = scenes::RecordedSpec::Ids::none;
  return spec;
}

/// What follows from the files or from options, but stands in the scene as something else, which the user never set.
void require_range(double value, double least, double most, const std::string& what, const char* remedy) {
  if (value >= least && value <= most) return;
  throw InputError(fmt::format("{} would be {:.4g}; expected {:g} to {:g}: {}", what, value, least, most, remedy));
}

void check_ranges(const scenes::Scene& scene) {
  require_range(scene.particles.spacing, 1e-9, 1000, "the spacing of the particles (m)",
                "--spacing sets it; larger scenes need a larger unit of length than the metre");
  require_range(scene.frame_rate, 1e-9, 1e5, "the number of files per second", "--frame-rate or --time-step sets it");
  require_range(scene.tracking.field.radius, 0.5, 10, "the effective radius, in spacings,",
                "--radius and --spacing set it");
  require_range(scene.tracking.edge_length, 0.05, 20, "the edge length, in spacings,",
                "--edge-length and --spacing set it");
}

scenes::Scene scene_of(const TrackOptions& options, ParticleSequence& sequence) {
  scenes::Scene scene;
  scene.directory = scenes::current_folder();
  scene.name = default_name(sequence.places.front().file);
  scene.description = "A surface tracked on recorded particles by `flowskin track`.";
  scene.particles.source = scenes::ParticlesSpec::Source::recorded;
  scene.particles.recorded = recorded_spec(options);
  // What was found out need not be found out again when the scene is run.
  if (sequence.ids == ParticleSequence::Ids::order) scene.particles.recorded.ids = scenes::RecordedSpec::Ids::order;
  if (sequence.ids == ParticleSequence::Ids::none) scene.particles.recorded.ids = scenes::RecordedSpec::Ids::none;
  scene.particles.spacing = spacing_of(options, sequence);
  set_times(options, sequence, scene);
  scene.tracking.steps_per_frame = 1;
  if (options.radius) scene.tracking.field.radius = *options.radius / scene.particles.spacing;
  if (options.edge_length) scene.tracking.edge_length = *options.edge_length / scene.particles.spacing;
  check_ranges(scene);
  if (!options.texture.empty()) scene.texture.image = options.texture;
  if (!options.mapping.empty()) scene.texture.mapping = options.mapping;
  if (options.tile_size) scene.texture.tile_size = *options.tile_size;
  if (options.run.velocity) scene.tracking.velocity = *options.run.velocity;
  set_pictures(options, sequence, scene);
  return scene;
}

/// Order and times, one file a line; what was taken for granted goes to standard error.
int list_files(const ParticleSequence& sequence) {
  for (const std::string& warning : sequence.warnings) warn(warning);
  for (const std::string& note : sequence.notes) say_line(note);
  for (std::size_t k = 0; k < sequence.places.size(); ++k)
    put(fmt::format(
        "{}  {:.9g} s  {}{}\n", k, sequence.times[k], sequence.places[k].name(),
        sequence.places[k].more.empty() ? "" : fmt::format(" and {} more", sequence.places[k].more.size())));
  return 0;
}

int track(const TrackOptions& options) {
  ParticleSequence sequence = scenes::open_sequence(recorded_spec(options), scenes::current_folder());
  if (options.list) return list_files(sequence);
  for (const std::string& warning : sequence.warnings) warn(warning);
  tell(options, fmt::format("{} {} from {}, one every {:.6g} s", sequence.places.size(),
                            sequence.places.size() == 1            ? "file"
                            : sequence.places.front().is_only_step ? "files"
                                                                   : "time steps",
                            sequence.places.front().file.string(), sequence.interval));
  for (const std::string& note : sequence.notes) tell(options, note);
  RunOptions run = options.run;
  scenes::Scene scene = scene_of(options, sequence);
  run.frames = scene.frames;
  run.out_is_default = run.out.empty();
  if (run.out_is_default) run.out = fs::path("output") / scene.name;
  const double spacing = scene.particles.spacing;
  tell(options,
       fmt::format("effective radius {:.4g} m ({:.3g} spacings), edge length {:.4g} m ({:.3g} spacings), velocity {}",
                   scene.tracking.field.radius * spacing, scene.tracking.field.radius,
                   scene.tracking.edge_length * spacing, scene.tracking.edge_length, scene.tracking.velocity));
  // As if read from a file: every value is checked, and scene.json in the run directory repeats this run.
  run_scene(scenes::parse_scene(scenes::write_scene(scene), "the options of flowskin track", scene.directory), run);
  return 0;
}

std::vector<Option> files_options(TrackOptions& chosen) {
  constexpr std::pair<double, double> lengths{1e-9, 1e6}, rates{1e-5, 1e5};
  return {
      {"particles",
       &chosen.particles,
       "Files, a pattern in quotes such as 'run/p_*.vtp' or p_%04d.ply, a folder, one file of many steps, or one .pvd; "
       "columns x, y, z and, "
       "where there are any, velocity, id, radius",
       {.is_required = true}},
      {"--out", &chosen.run.out, "Run directory (default: output/track_<name of the files>); see --overwrite"},
      {"--spacing",
       &chosen.spacing,
       "Distance of neighbouring particles (m; default: from the radius in the files, else estimated)",
       {.range = lengths}},
      {"--radius",
       &chosen.radius,
       "Effective radius of a particle (m; default: 2.5 spacings); smaller shows more detail",
       {.range = lengths}},
      {"--edge-length", &chosen.edge_length, "Target edge of the mesh (m; default: 0.75 spacings)", {.range = lengths}},
      {"--frame-rate",
       &chosen.frame_rate,
       "Files per second (default: the times in the files, else 30)",
       {.range = rates}},
      {"--time-step",
       &chosen.time_step,
       "The same as seconds between files",
       {.range = rates, .excludes = "--frame-rate"}},
      {"--times-in-names", &chosen.times_in_names,
       "The numbers in the names of the files are their times (s), as in Result-0.0005.csv or 0.25/particles.csv"},
      {"--keep", &chosen.keep, "Only particles whose columns fulfil this, such as 'Type == 1 and z > 0.5'"},
      {"--region",
       &chosen.region,
       "Only particles between two corners: XMIN YMIN ZMIN XMAX YMAX ZMAX (m)",
       {.count = 6}},
      {"--skip-invalid", &chosen.skip_invalid, "Leave out particles with values that are missing or not finite"},
      {"--skip-duplicates", &chosen.skip_duplicates,
       "Leave out particles whose id or place an earlier one of the same file has"},
      {"--list", &chosen.list, "Print the files in their order, with their times, and do nothing else"},
      {"--frames", &chosen.run.frames, "Number of frames after the first (default: all)", {.range = {{1, 1000000}}}},
      velocity_option(chosen.run.velocity, "auto"),
      {"--no-ids", &chosen.no_ids, "Do not match particles from file to file, neither by id nor by order"},
  };
}

std::vector<Option> looks_options(TrackOptions& chosen) {
  return {
      {"--texture", &chosen.texture, "checker, marble or an image file (default: checker)"},
      {"--mapping",
       &chosen.mapping,
       "How the texture is put on: box, planar or spherical (default: box)",
       {.words = {"box", "planar", "spherical"}}},
      {"--tile-size",
       &chosen.tile_size,
       "Edge of one copy of the texture (m; default: by the fluid's size)",
       {.range = {{1e-9, 1e6}}}},
      {"--up", &chosen.up, "Axis that points up in the pictures", {.words = {"y", "z"}, .shows_default = true}},
      threads_option(chosen.run.threads),
      {"--resume", &chosen.run.resume,
       "Go on from the last checkpoint in the run directory; more files may have come; see docs/restart.md"},
      overwrite_option(chosen.run),
      hangup_option(chosen.run),
      chosen.pictures.pictures_option(),
      chosen.pictures.video_option(),
      {"--quiet", &chosen.run.quiet, "No progress; warnings and errors only"},
  };
}

}  // namespace

Command track_command() {
  const auto chosen = std::make_shared<TrackOptions>();
  std::vector<Option> options = files_options(*chosen);
  for (Option& option : looks_options(*chosen)) options.push_back(std::move(option));
  return {"track", "Track a textured surface on recorded particles of any program: CSV, PLY, VTK, VTP (docs/track.md)",
          options, [chosen](const std::string& command_line) {
            chosen->run.command_line = command_line;
            chosen->pictures.apply(chosen->run);
            return track(*chosen);
          }};
}

}  // namespace flowskin::tools
