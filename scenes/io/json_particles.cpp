#include "scenes/io/json_particles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "common/errors.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_json_columns = 4096;

Json json_of(std::string_view bytes, const std::string& name) {
  try {
    return Json::parse(bytes.begin(), bytes.end());
  } catch (const Json::exception& error) {
    const std::string what = error.what();
    const std::size_t start = what.find("] ");
    throw InputError(fmt::format("{}: this is no JSON: {}", name, start == what.npos ? what : what.substr(start + 2)));
  }
}

class JsonParticles {
 public:
  explicit JsonParticles(const std::string& name) : name_(name) {}

  /// @param root a step, a list of steps under "frames" or "steps", or what "particles" holds
  std::vector<ParticleTable> steps(const Json& root) const {
    std::vector<ParticleTable> tables;
    for (const char* key : {"frames", "steps", "timesteps"}) {
      if (!root.is_object() || !root.contains(key) || !root[key].is_array()) continue;
      for (const Json& step : root[key]) tables.push_back(table_of(step));
      return tables;
    }
    tables.push_back(table_of(root));
    return tables;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  ParticleTable table_of(const Json& step) const {
    ParticleTable table;
    const Json* particles = &step;
    for (const char* key : {"particles", "points"})
      if (step.is_object() && step.contains(key) && step[key].is_structured()) particles = &step[key];
    if (particles->is_array()) {
      add_rows(table, *particles);
    } else if (particles->is_object()) {
      add_arrays(table, *particles);
    } else {
      fail("expected an array of particles, or an object with \"positions\"");
    }
    if (step.is_object())
      for (const char* key : {"time", "t"})
        if (step.contains(key) && step[key].is_number()) table.time = step[key].get<double>();
    table.format = "JSON";
    return table;
  }

  static double number_in(const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }

  /// Appends a value of particle i; what is no number is a fault.
  static void add_value(ParticleTable& table, const std::string& column, std::size_t i, const Json& value) {
    std::vector<double>& values = table.columns[column];
    values.resize(i, std::nan(""));
    if (values.size() != i) return;  // a second member of this name
    values.push_back(number_in(value));
    if (!value.is_number())
      return note_fault(table, column, fmt::format("particle {}: \"{}\" is no number", i + 1, column));
    if (!value.is_number_integer() || !is_id_name(column)) return;
    std::vector<std::uint64_t>& ids = table.ids[column];
    if (ids.size() == i)
      ids.push_back(value.is_number_unsigned() ? value.get<std::uint64_t>()
                                               : static_cast<std::uint64_t>(value.get<std::int64_t>()));
  }

  /// A member of particle i: a number, an array of numbers, or an object of numbers ({"x": 1, ...}).
  void add_member(ParticleTable& table, const std::string& key, std::size_t i, const Json& value) const {
    if (table.columns.size() > most_json_columns) fail("more than 4096 columns; these are no particles");
    if (value.is_array() && value.size() <= most_json_columns) {
      for (std::size_t k = 0; k < value.size(); ++k) add_value(table, fmt::format("{}_{}", key, k), i, value[k]);
    } else if (value.is_object()) {
      for (const auto& [inner, number] : value.items()) add_value(table, key + "_" + inner, i, number);
    } else {
      add_value(table, key, i, value);
    }
  }

  /// A particle an entry: [x, y, z] or an object.
  void add_rows(ParticleTable& table, const Json& rows) const {
    for (const Json& row : rows) {
      const std::size_t i = table.count++;
      if (row.is_array()) {
        if (row.size() != 3)
          fail(fmt::format("particle {} is an array of {} entries; expected [x, y, z], or objects with names", i + 1,
                           row.size()));
        for (const std::size_t k : {0, 1, 2}) add_value(table, std::string(1, "xyz"[k]), i, row[k]);
      } else if (row.is_object()) {
        for (const auto& [key, value] : row.items()) add_member(table, key, i, value);
      } else {
        fail(fmt::format("particle {} is neither [x, y, z] nor an object", i + 1));
      }
    }
    complete(table);
  }

  /// An array a property: of numbers, or of vectors.
  void add_arrays(ParticleTable& table, const Json& arrays) const {
    for (const auto& [key, values] : arrays.items()) {
      if (!values.is_array() || values.empty()) continue;
      if (names_positions({key + "x", key + "y"}) || key == "x") table.count = values.size();
    }
    for (const auto& [key, values] : arrays.items()) {
      if (values.is_array() && values.size() != table.count && is_velocity_name(key))
        fail(fmt::format("\"{}\" has {} entries for {} particles", key, values.size(), table.count));
      if (!values.is_array() || values.size() != table.count) {
        if (values.is_array() && is_id_name(key)) note_misfit(table, key, values.size());
        continue;
      }
      for (std::size_t i = 0; i < values.size(); ++i) add_member(table, key, i, values[i]);
    }
    if (arrays.empty()) fail("the object is empty; expected \"positions\", or \"x\", \"y\" and \"z\", each an array");
    if (table.columns.empty()) {
      std::vector<std::string> keys;
      for (const auto& member : arrays.items()) keys.push_back(member.key().substr(0, 40));
      keys.resize(std::min<std::size_t>(keys.size(), 20));
      if (!arrays.contains("positions"))
        fail(fmt::format("expected \"positions\", or \"x\", \"y\" and \"z\", each an array; there are: {}",
                         fmt::join(keys, ", ")));
    }
    complete(table);
  }

  /// Ids of another number than the particles matter only where ids are asked for.
  static void note_misfit(ParticleTable& table, const std::string& key, std::size_t entries) {
    note_fault(table, key, fmt::format("\"{}\" has {} entries for {} particles", key, entries, table.count));
    table.columns[key].assign(table.count, std::nan(""));
  }

  static void complete(ParticleTable& table) {
    for (auto& [name, values] : table.columns) {
      if (values.size() == table.count) continue;
      note_fault(table, name, fmt::format("particle {} has no \"{}\"", values.size() + 1, name));
      values.resize(table.count, std::nan(""));
    }
    std::erase_if(table.ids, [&](const auto& ids) { return ids.second.size() != table.count; });
    if (table.count == 0)
      for (const char* axis : {"x", "y", "z"}) table.columns[axis];
  }

  const std::string& name_;
};

}  // namespace

std::vector<ParticleTable> parse_json_particles(std::string_view bytes, const std::string& name) {
  const Json root = json_of(bytes, name);
  if (root.is_object() && root.contains("file-series-version"))
    throw InputError(name + ": this names the files of a series; give it alone, not among others");
  return JsonParticles(name).steps(root);
}

bool is_json_particles(std::string_view bytes) {
  const Json root = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (root.is_array()) return true;
  if (!root.is_object()) return false;
  const auto holds_places = [](const Json& object) {
    if (object.is_array()) return true;
    for (const auto& [key, value] : object.items())
      if (value.is_array() && (names_positions({key + "x", key + "y"}) || key == "x")) return true;
    return false;
  };
  for (const char* key : {"particles", "points", "frames", "steps", "timesteps"})
    if (root.contains(key) && root[key].is_structured() && holds_places(root[key])) return true;
  return holds_places(root);
}

bool is_file_series(std::string_view bytes) {
  return bytes.substr(0, 4096).find("\"file-series-version\"") != std::string_view::npos;
}

std::vector<std::pair<double, std::string>> parse_file_series(std::string_view bytes, const std::string& name) {
  const Json root = json_of(bytes, name);
  if (!root.is_object() || !root.contains("files") || !root["files"].is_array() || root["files"].empty())
    throw InputError(name + ": expected \"files\": [{\"name\": NAME, \"time\": SECONDS}, ...]");
  std::vector<std::pair<double, std::string>> entries;
  for (const Json& entry : root["files"]) {
    const auto time = static_cast<double>(entries.size());
    const bool is_entry = entry.is_object() && entry.contains("name") && entry["name"].is_string();
    const bool has_time = is_entry && entry.contains("time");
    if (!is_entry || (has_time && !entry["time"].is_number()))
      throw InputError(fmt::format("{}: entry {} of \"files\" lacks a name or a time", name, entries.size() + 1));
    entries.emplace_back(has_time ? entry["time"].get<double>() : time, entry["name"].get<std::string>());
  }
  return entries;
}

}  // namespace flowskin::scenes
