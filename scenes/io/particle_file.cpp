#include "scenes/io/particle_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/csv_reader.h"
#include "scenes/io/ply_reader.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/utf16.h"
#include "scenes/io/vtk_reader.h"
#include "scenes/io/vtp_reader.h"

namespace flowskin::scenes {
namespace {

constexpr std::array<const char*, 7> extensions{".csv", ".txt", ".tsv", ".ply", ".vtk", ".vtp", ".vtu"};

}  // namespace

bool is_particle_extension(std::string extension) {
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::string particle_extensions() { return fmt::format("{}", fmt::join(extensions, ", ")); }

ParticleTable parse_particle_table(std::string_view bytes, const std::string& name) {
  if (is_utf16(bytes)) return parse_particle_table(utf8_of_utf16(bytes), name);
  if (bytes.empty()) throw InputError(name + ": the file is empty");
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return table_from_ply(parse_ply(bytes, name));
  if (bytes.starts_with("# vtk DataFile")) return parse_vtk(bytes, name);
  std::string_view start = bytes.substr(0, 4096);
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  skip_space(start);
  if (start.starts_with("<")) return parse_vtp(bytes, name);
  if (start.find('\0') != std::string_view::npos)
    throw InputError(name +
                     ": these are no particles that FlowSkin can read; expected CSV, PLY, VTK or VTP (see "
                     "docs/track.md)");
  return parse_csv(bytes, name);
}

ParticleTable read_particle_table(const std::filesystem::path& file) {
  return parse_particle_table(read_bytes(file), file.string());
}

ParticleFile read_particles(const std::filesystem::path& file, const ParticleNeeds& needs) {
  const ParticleTable table = read_particle_table(file);
  if (table.polygons > 0)
    throw InputError(
        fmt::format("{}: this is a mesh with {} polygons, not particles; give the particles it was made of",
                    file.string(), table.polygons));
  ParticleFile particles = particles_from_table(table, file.string(), needs);
  if (table.time) particles.state.time = *table.time;
  return particles;
}

}  // namespace flowskin::scenes
