#include "scenes/sources/frame_tables.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "common/errors.h"
#include "scenes/io/checksum.h"
#include "scenes/io/join_tables.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/read_bytes.h"

namespace flowskin::scenes {

std::string FrameTables::Place::name() const {
  return is_only_step ? file.string() : fmt::format("{}, time step {}", file.string(), step + 1);
}

const std::vector<ParticleTable>& FrameTables::steps(const std::filesystem::path& file) {
  if (kept_file_ != file || kept_.empty()) {
    kept_.clear();
    kept_ = read_particle_steps(file);
    kept_file_ = file;
  }
  return kept_;
}

ParticleTable FrameTables::table(const Place& place) {
  if (!place.is_only_step) {
    const std::vector<ParticleTable>& all = steps(place.file);
    if (place.step >= all.size())
      throw InputError(fmt::format("{}: is no longer there, the file has {} time steps", place.name(), all.size()));
    return all[place.step];
  }
  std::vector<ParticleTable> all =
      kept_file_ == place.file && kept_.size() == 1 ? std::exchange(kept_, {}) : read_particle_steps(place.file);
  if (all.size() > 1)
    throw InputError(fmt::format("{}: holds {} time steps, where files of one step each are expected: give it alone",
                                 place.file.string(), all.size()));
  ParticleTable whole = std::move(all.front());
  for (const std::filesystem::path& part : place.more) append_part(whole, read_particle_table(part));
  return whole;
}

std::uint32_t checksum_of_place(const FrameTables::Place& place, FrameTables& tables) {
  std::uint32_t sum = 0;
  if (place.is_only_step) {
    sum = checksum(sum, read_bytes(place.file));
    for (const std::filesystem::path& part : place.more) sum = checksum(sum, read_bytes(part));
    return sum;
  }
  const ParticleTable table = tables.table(place);
  const auto add = [&](const std::string& name, const auto& values) {
    sum = checksum(sum, name);
    sum = checksum(sum, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])});
  };
  for (const auto& [name, values] : table.columns) add(name, values);
  for (const auto& [name, ids] : table.ids) add(name, ids);
  return sum;
}

std::uint64_t size_of_place(const FrameTables::Place& place, FrameTables& tables) {
  if (!place.is_only_step) return tables.table(place).count;
  std::uint64_t size = 0;
  const auto add = [&](const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    size += error ? 0 : bytes;
  };
  add(place.file);
  for (const std::filesystem::path& part : place.more) add(part);
  return size;
}

}  // namespace flowskin::scenes
