#include "scenes/io/file_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/frames.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/ply_reader.h"
#include "scenes/io/read_bytes.h"
#include "scenes/sources/particle_sequence.h"
#include "scenes/sources/particle_spacing.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/self_intersections.h"

namespace flowskin::scenes {
namespace {

using Positions = std::vector<Vec3>;
using Triangles = std::vector<tracking::Triangle>;

/// Bytes at the start of a file that tell what it is.
constexpr std::size_t telling_start = 1 << 16;
/// Lines of an OBJ file within which its kind shows.
constexpr std::size_t most_obj_head = 1000;

std::string bounds_line(const Positions& positions) {
  Vec3 low = positions[0], high = positions[0];
  for (const Vec3& x : positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return fmt::format("bounds: x {:.6g} to {:.6g}, y {:.6g} to {:.6g}, z {:.6g} to {:.6g} m", low.x(), high.x(), low.y(),
                     high.y(), low.z(), high.z());
}

std::string property_line(const std::map<std::string, std::vector<double>>& columns) {
  std::string names;
  for (const auto& [name, column] : columns) names += (names.empty() ? "" : " ") + name;
  return "properties: " + names;
}

Positions vertex_positions(const std::map<std::string, std::vector<double>>& columns, std::size_t count,
                           const std::string& name) {
  Positions positions(count);
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const auto column = columns.find(axes[k]);
    if (column == columns.end()) throw InputError(name + ": no vertex property \"" + axes[k] + "\"");
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i][k] = column->second[i];
  }
  return positions;
}

/// How many pairs of triangles intersect, and the first with its place; empty: none do.
std::string intersection_line(const Positions& positions, const Triangles& triangles) {
  const auto pairs = tracking::self_intersections(positions, triangles);
  if (pairs.empty()) return {};
  const auto& [a, b, c] = triangles[pairs[0][0]];
  const Vec3 place = (positions[a] + positions[b] + positions[c]) / 3;
  return fmt::format("{} pairs of triangles intersect, the first triangles {} and {} near ({:.6g}, {:.6g}, {:.6g}) m",
                     pairs.size(), pairs[0][0], pairs[0][1], place.x(), place.y(), place.z());
}

void describe_surface(FileInfo& info, const Positions& positions, const Triangles& triangles) {
  info.lines.push_back(fmt::format("surface: {} vertices, {} triangles", positions.size(), triangles.size()));
  info.lines.push_back(bounds_line(positions));
  std::vector<std::string> problems = tracking::mesh_problems(positions, triangles);
  try {
    if (const std::string line = intersection_line(positions, triangles); !line.empty()) problems.push_back(line);
  } catch (const std::invalid_argument& error) {
    if (problems.empty()) problems.push_back(std::string("intersections cannot be looked for: ") + error.what());
  }
  info.sound = problems.empty();
  info.lines.push_back(fmt::format("area: {:.6g} m^2", tracking::mesh_area(positions, triangles)));
  if (info.sound) {
    info.lines.push_back(fmt::format("volume: {:.6g} m^3", tracking::mesh_volume(positions, triangles)));
    info.lines.push_back(fmt::format("parts: {}, Euler characteristic {}",
                                     tracking::mesh_components(positions, triangles).count,
                                     tracking::euler_characteristic(positions, triangles)));
    const tracking::MeshQuality quality = tracking::mesh_quality(positions, triangles);
    info.lines.push_back(fmt::format("edges: {:.4g} to {:.4g} m, mean {:.4g} m", quality.shortest_edge,
                                     quality.longest_edge, quality.mean_edge));
    info.lines.emplace_back("sound: closed, two-manifold, outward, no unreferenced vertex, no self-intersection");
  } else {
    info.lines.emplace_back("not a sound closed surface:");
    for (const std::string& problem : problems) info.lines.push_back("  " + problem);
  }
}

template <class T, class Measure>
std::string range_line(const char* what, const char* unit, const std::vector<T>& values, Measure measure) {
  double low = measure(values[0]), high = low, sum = 0;
  for (const T& value : values) {
    low = std::min(low, measure(value));
    high = std::max(high, measure(value));
    sum += measure(value);
  }
  return fmt::format("{}: {:.6g} to {:.6g} {}, mean {:.6g}", what, low, high, unit,
                     sum / static_cast<double>(values.size()));
}

void describe_particles(FileInfo& info, const std::string& name, const ParticleTable& table) {
  const ParticleFile file = particles_from_table(table, name);
  const ParticleState& state = file.state;
  info.lines.push_back(fmt::format("particles: {} ({})", state.positions.size(), table.format));
  info.lines.push_back(property_line(table.columns));
  if (table.time) info.lines.push_back(fmt::format("time: {:.6g} s", *table.time));
  if (state.positions.empty()) return;
  info.lines.push_back(bounds_line(state.positions));
  if (const SpacingEstimate estimate = estimate_spacing(state.positions); estimate.spacing > 0) {
    info.lines.push_back(fmt::format("spacing: about {:.4g} m (estimated: {}, to within some {:.0f} %)",
                                     estimate.spacing, estimate.method, 100 * estimate.uncertainty));
    if (estimate.coincident > 0)
      info.lines.push_back(fmt::format("coincident: {} particles are in places that others have", estimate.coincident));
    if (estimate.dimensions < 3)
      info.lines.push_back(fmt::format("all in a {}", estimate.dimensions == 2 ? "plane (two dimensions)" : "line"));
  }
  if (file.has_velocities)
    info.lines.push_back(range_line("speed", "m/s", state.velocities, [](const Vec3& v) { return v.norm(); }));
  if (std::any_of(state.densities.begin(), state.densities.end(), [](double d) { return d != 0; }))
    info.lines.push_back(range_line("density", "kg/m^3", state.densities, std::identity()));
  info.lines.push_back(file.has_ids ? fmt::format("ids: {} to {}, each once", state.ids.front(), state.ids.back())
                                    : "ids: none");
  if (!file.has_velocities) info.lines.emplace_back("velocities: none");
  info.lines.emplace_back("sound: all values finite");
}

}  // namespace

namespace {

/// Whether a text is an OBJ mesh: a line of a face, and nothing in front but words that OBJ files have.
bool is_obj(std::string_view text) {
  constexpr std::array<std::string_view, 10> words{"v", "vt", "vn", "vp", "f", "o", "g", "s", "mtllib", "usemtl"};
  for (std::size_t lines = 0; !text.empty() && lines < most_obj_head; ++lines) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string_view word = take_word(line);
    if (word.empty() || word.starts_with('#')) continue;
    if (std::find(words.begin(), words.end(), word) == words.end()) return false;
    if (word == "f" || word == "mtllib") return true;
  }
  return text.find("\nf ") != std::string_view::npos;
}

FileInfo describe_ply(const PlyFile& ply, const std::string& name) {
  FileInfo info;
  if (ply.triangles.empty()) {
    describe_particles(info, name, table_from_ply(ply));
  } else {
    describe_surface(info, vertex_positions(ply.vertex, ply.vertex_count, name), ply.triangles);
    info.lines.insert(info.lines.begin() + 1, property_line(ply.vertex));
  }
  return info;
}

void describe_steps(FileInfo& info, const std::vector<ParticleTable>& steps) {
  if (steps.size() < 2) return;
  std::string line = fmt::format("time steps: {}", steps.size());
  if (steps.front().time && steps.back().time)
    line += fmt::format(", {:.6g} to {:.6g} s", *steps.front().time, *steps.back().time);
  if (steps.front().step && steps.back().step)
    line += fmt::format(", numbered {} to {}", *steps.front().step, *steps.back().step);
  info.lines.push_back(line + "; of the first:");
}

/// A mesh that is written as points and faces.
void describe_mesh(FileInfo& info, const std::string& name, const ParticleTable& table) {
  if (table.triangles.empty())
    throw InputError(fmt::format("{}: a mesh with {} polygons; of meshes, OBJ, PLY and VTP files can be looked at",
                                 name, table.polygons));
  describe_surface(info, vertex_positions(table.columns, table.count, name), table.triangles);
  info.lines.insert(info.lines.begin() + 1, property_line(table.columns));
}

void describe_tables(FileInfo& info, const std::string& name, const std::vector<ParticleTable>& steps) {
  describe_steps(info, steps);
  for (const std::string& note : steps.front().notes) info.lines.push_back("note: " + note);
  if (steps.front().polygons > 0)
    describe_mesh(info, name, steps.front());
  else
    describe_particles(info, name, steps.front());
}

}  // namespace

FileInfo describe_file(const std::filesystem::path& file) {
  const std::string start = first_bytes(file, telling_start);
  FileInfo info;
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return describe_ply(read_ply(file), file.string());
  if (file.extension() == ".obj" || is_obj(start)) {
    const sph::TriangleMesh mesh = read_obj(file);
    describe_surface(info, mesh.positions, mesh.triangles);
    return info;
  }
  describe_tables(info, file.string(), read_particle_steps(file));
  return info;
}

namespace {

/// The files of one frame, whose particles are read as one.
FileInfo describe_frame(const FrameTables::Place& frame) {
  if (frame.more.empty()) return describe_file(frame.file);
  FileInfo info;
  std::vector<ParticleTable> steps;
  steps.push_back(FrameTables().table(frame));
  describe_tables(info, frame.name(), steps);
  return info;
}

bool is_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// What tells the first file from the last: their names or, where those are the same, those of their folders, too.
std::string name_beside(const std::filesystem::path& file, const std::filesystem::path& other) {
  return file.filename() != other.filename() || file == other
             ? file.filename().string()
             : (file.parent_path().filename() / file.filename()).string();
}

}  // namespace

FileInfo describe_sequence(const std::filesystem::path& place) {
  RecordedSpec spec;
  spec.files = {std::filesystem::absolute(place).string()};
  const std::vector<FrameTables::Place> frames = sequence_places(spec, "");
  FileInfo info;
  std::size_t files = 0;
  std::vector<std::string> missing;
  const FrameTables::Place* whole = nullptr;  // the first frame that is all there
  for (const FrameTables::Place& frame : frames) {
    std::vector<std::filesystem::path> parts = frame.more;
    parts.insert(parts.begin(), frame.file);
    files += parts.size();
    const std::size_t missing_before = missing.size();
    for (const std::filesystem::path& part : parts)
      if (!is_there(part)) missing.push_back(fmt::format("missing: {}", part.string()));
    if (whole == nullptr && missing.size() == missing_before) whole = &frame;
  }
  const std::filesystem::path &first = frames.front().file, &last = frames.back().file;
  info.lines.push_back(fmt::format("sequence: {} files{}, {} to {}{}", files,
                                   files > frames.size() ? fmt::format(" for {} times", frames.size()) : "",
                                   name_beside(first, last), name_beside(last, first),
                                   whole == nullptr           ? ""
                                   : whole != &frames.front() ? fmt::format("; of {}:", whole->name())
                                   : whole->more.empty()      ? "; of the first:"
                                                              : "; of the first, its parts read as one:"));
  if (whole != nullptr) {
    const FileInfo described = describe_frame(*whole);
    info.sound = described.sound;
    info.lines.insert(info.lines.end(), described.lines.begin(), described.lines.end());
  }
  info.sound = info.sound && missing.empty();
  info.lines.insert(info.lines.end(), missing.begin(), missing.end());
  return info;
}

}  // namespace flowskin::scenes
