#include "scenes/io/particle_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/bgeo_reader.h"
#include "scenes/io/csv_reader.h"
#include "scenes/io/hdf5_reader.h"
#include "scenes/io/inflate.h"
#include "scenes/io/join_tables.h"
#include "scenes/io/json_particles.h"
#include "scenes/io/lammps_reader.h"
#include "scenes/io/npy_reader.h"
#include "scenes/io/ply_reader.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/time_columns.h"
#include "scenes/io/unreadable_formats.h"
#include "scenes/io/utf16.h"
#include "scenes/io/vtk_reader.h"
#include "scenes/io/vtp_reader.h"
#include "scenes/io/xyz_reader.h"

namespace flowskin::scenes {
namespace {

constexpr std::array<const char*, 21> extensions{
    ".csv",  ".txt",       ".tsv", ".ply",    ".vtk", ".vtp", ".vtu", ".pvtp", ".pvtu",   ".bgeo",  ".bhclassic",
    ".dump", ".lammpstrj", ".xyz", ".extxyz", ".npy", ".npz", ".h5",  ".hdf5", ".h5part", ".vtkhdf"};

/// So much of a file tells its format.
constexpr std::size_t telling_bytes = 4096;

std::vector<ParticleTable> one_step(ParticleTable table) {
  std::vector<ParticleTable> steps;
  steps.push_back(std::move(table));
  return steps;
}

[[noreturn]] void refuse_format(std::string_view what, const std::string& name) {
  throw InputError(fmt::format("{}: cannot be read, this is {}", name, what));
}

/// Formats that are text.
std::vector<ParticleTable> parse_text_steps(std::string_view bytes, const std::string& name) {
  std::string_view start = bytes.substr(0, telling_bytes);
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  skip_space(start);
  if (const std::string_view what = unreadable_text(bytes); !what.empty()) refuse_format(what, name);
  if (start.starts_with('<')) return one_step(parse_vtp(bytes, name));
  if (start.find('\0') != std::string_view::npos) {
    if (const std::string_view what = unreadable_ending(name); !what.empty()) refuse_format(what, name);
    throw InputError(name +
                     ": these are no particles that FlowSkin can read; expected one of the formats in "
                     "docs/track.md, such as CSV, PLY, VTK, BGEO, LAMMPS, XYZ, NumPy or HDF5");
  }
  if (is_lammps_dump(bytes)) return parse_lammps_dump(bytes, name);
  if (start.starts_with('{') || start.starts_with('[')) return parse_json_particles(bytes, name);
  if (is_xyz(bytes)) return parse_xyz(bytes, name);
  return one_step(parse_csv(bytes, name));
}

/// Other programs' formats that are HDF5 inside are told by their ending, where no particles are found.
std::vector<ParticleTable> parse_hdf5_file(std::string_view bytes, const std::string& name) {
  try {
    return parse_hdf5(bytes, name);
  } catch (const InputError&) {
    if (const std::string_view what = unreadable_ending(name); !what.empty()) refuse_format(what, name);
    throw;
  }
}

/// @param level of gzip within gzip
std::vector<ParticleTable> parse_steps(std::string_view bytes, const std::string& name, int level) {
  if (bytes.empty()) throw InputError(name + ": the file is empty");
  if (is_gzip(bytes)) {
    if (level > 0) throw InputError(name + ": is compressed twice; unpack it: gzip -d FILE");
    return parse_steps(gunzipped(bytes, name), name, level + 1);
  }
  if (is_utf16(bytes)) return parse_text_steps(utf8_of_utf16(bytes), name);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return one_step(table_from_ply(parse_ply(bytes, name)));
  if (bytes.starts_with("# vtk DataFile")) return one_step(parse_vtk(bytes, name));
  if (is_bgeo(bytes)) return one_step(parse_bgeo(bytes, name));
  if (is_npy(bytes)) return parse_npy(bytes, name);
  if (const std::string_view what = unreadable_format(bytes); !what.empty()) refuse_format(what, name);
  if (is_zip(bytes)) return parse_npz(bytes, name);
  if (is_hdf5(bytes)) return parse_hdf5_file(bytes, name);
  return parse_text_steps(bytes, name);
}

}  // namespace

bool is_particle_extension(std::string extension) {
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension.ends_with(".gz")) extension.resize(extension.size() - 3);
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::string particle_extensions() { return fmt::format("{}", fmt::join(extensions, ", ")); }

std::vector<ParticleTable> parse_particle_steps(std::string_view bytes, const std::string& name) {
  std::vector<ParticleTable> steps = parse_steps(bytes, name, 0);
  if (steps.empty()) throw InputError(name + ": there are no particles in the file");
  if (steps.size() > 1) return steps;
  const bool is_text = steps.front().format == "CSV" || steps.front().format == "JSON";
  return steps_by_time_column(std::move(steps.front()), is_text ? TableKind::text : TableKind::arrays);
}

ParticleTable parse_particle_table(std::string_view bytes, const std::string& name) {
  return std::move(parse_particle_steps(bytes, name).front());
}

std::vector<ParticleTable> read_particle_steps(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  const std::vector<std::filesystem::path> pieces = pieces_of_vtk(bytes, file);
  if (pieces.empty()) return parse_particle_steps(bytes, file.string());
  ParticleTable whole;
  for (const std::filesystem::path& piece : pieces)
    append_part(whole, parse_particle_table(read_bytes(piece), piece.string()));
  return one_step(std::move(whole));
}

ParticleTable read_particle_table(const std::filesystem::path& file) {
  return std::move(read_particle_steps(file).front());
}

ParticleFile particles_of_file(const ParticleTable& table, const std::string& name, const ParticleNeeds& needs) {
  if (table.polygons > 0)
    throw InputError(fmt::format(
        "{}: this is a mesh with {} polygons, not particles; give the particles it was made of", name, table.polygons));
  ParticleFile particles = particles_from_table(table, name, needs);
  if (table.time) particles.state.time = *table.time;
  return particles;
}

ParticleFile read_particles(const std::filesystem::path& file, const ParticleNeeds& needs) {
  return particles_of_file(read_particle_table(file), file.string(), needs);
}

}  // namespace flowskin::scenes
