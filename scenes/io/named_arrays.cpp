#include "scenes/io/named_arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "common/errors.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

constexpr std::uint64_t most_array_components = 64;
constexpr std::uint64_t most_array_copies = 4;

/// How many particles there are, and how many steps.
struct ArrayLayout {
  std::uint64_t particles = 0, steps = 1;
  bool has_steps = false;
};

/// How an array's entries lie: steps, particles, components.
struct ArrayFit {
  std::uint64_t components = 1;
  bool per_step = false;
};

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  return shape.empty() ? "one number" : fmt::format("{}", fmt::join(shape, " x "));
}

bool is_vector_of_places(const NamedArray& array) {
  const std::string plain = plain_column_name(array.name);
  const bool is_named = names_positions({plain + "x", plain + "y"}) || plain == "x" || plain.empty();
  return is_named && (array.shape.size() == 2 || array.shape.size() == 3) && array.shape.back() == 3;
}

/// By the array of places; by the first coordinate where there is none.
std::optional<ArrayLayout> layout_of(const std::vector<NamedArray>& arrays) {
  const auto places = std::find_if(arrays.begin(), arrays.end(), is_vector_of_places);
  if (places != arrays.end()) {
    const bool has_steps = places->shape.size() == 3;
    return ArrayLayout{places->shape[has_steps ? 1 : 0], has_steps ? places->shape[0] : 1, has_steps};
  }
  std::vector<std::string> names;
  for (const NamedArray& array : arrays) names.push_back(array.name);
  if (!names_positions(names)) return std::nullopt;
  for (const NamedArray& array : arrays) {
    const std::string plain = plain_column_name(array.name);
    const bool is_first = plain.ends_with('x') || plain.ends_with('0');
    if (!is_first || array.shape.empty() || array.shape.size() > 2) continue;
    const std::string base = plain.substr(0, plain.size() - 1);
    if (!names_positions({base + "x", base + "y"}) && !names_positions({base + "0", base + "1"})) continue;
    const bool has_steps = array.shape.size() == 2;
    return ArrayLayout{array.shape.back(), has_steps ? array.shape[0] : 1, has_steps};
  }
  return std::nullopt;
}

std::optional<ArrayFit> fit_of(const NamedArray& array, const ArrayLayout& layout) {
  std::vector<std::uint64_t> shape = array.shape;
  ArrayFit fit;
  if (layout.has_steps && shape.size() >= 2 && shape[0] == layout.steps && shape[1] == layout.particles) {
    fit.per_step = true;
    shape.erase(shape.begin());
  }
  if (shape.empty() || shape.size() > 2 || shape[0] != layout.particles) return std::nullopt;
  if (shape.size() == 2) fit.components = shape[1];
  if (fit.components == 0 || fit.components > most_array_components) return std::nullopt;
  return fit;
}

std::vector<std::string> columns_of(const NamedArray& array, std::uint64_t components) {
  if (is_vector_of_places(array)) return {"x", "y", "z"};
  if (components == 1) return {array.name};
  std::vector<std::string> names;
  for (std::uint64_t k = 0; k < components; ++k) names.push_back(fmt::format("{}_{}", array.name, k));
  return names;
}

void add_array(const NamedArray& array, const ArrayLayout& layout, const ArrayFit& fit,
               std::vector<ParticleTable>& tables) {
  const std::vector<std::string> names = columns_of(array, fit.components);
  const std::uint64_t length = layout.particles * fit.components;
  for (std::uint64_t step = 0; step < layout.steps; ++step) {
    ParticleTable& table = tables[step];
    const std::uint64_t start = fit.per_step ? step * length : 0;
    for (std::uint64_t k = 0; k < names.size(); ++k) {
      const auto [place, is_new] = table.columns.try_emplace(names[k]);
      if (!is_new) continue;
      place->second.reserve(layout.particles);
      for (std::uint64_t i = k; i < length; i += fit.components) place->second.push_back(array.values[start + i]);
    }
    if (fit.components != 1 || array.whole.empty() || !is_id_name(array.name)) continue;
    const auto first = array.whole.begin() + static_cast<std::ptrdiff_t>(start);
    table.ids[array.name].assign(first, first + static_cast<std::ptrdiff_t>(length));
  }
}

/// What is needed is not left out without a word: velocities of another number than the particles are an error, ids a
/// fault, which matters where ids are asked for.
void refuse_misfit(const NamedArray& array, const ArrayLayout& layout, std::vector<ParticleTable>& tables,
                   const std::string& name) {
  if (array.shape.empty()) return;
  const std::string what = fmt::format("the array \"{}\" has the shape {}, which does not fit {} particles{}",
                                       array.name, shape_text(array.shape), layout.particles,
                                       layout.has_steps ? fmt::format(" in {} time steps", layout.steps) : "");
  if (is_velocity_name(array.name)) throw InputError(name + ": " + what);
  if (!is_id_name(array.name)) return;
  for (ParticleTable& table : tables) {
    note_fault(table, array.name, what);
    table.columns[array.name].assign(table.count, std::nan(""));
  }
}

void add_times(const NamedArray& array, const ArrayLayout& layout, std::vector<ParticleTable>& tables,
               const std::string& name) {
  const std::string plain = plain_column_name(array.name);
  if (plain != "t" && plain != "time" && plain != "times" && plain != "timevalue") return;
  const std::size_t count = array.values.size();
  if (count == tables.size())
    for (std::size_t k = 0; k < tables.size(); ++k) tables[k].time = array.values[k];
  else if (count > 1 && tables.size() > 1 && count != layout.particles && count != layout.particles * layout.steps)
    throw InputError(
        fmt::format("{}: the array \"{}\" has {} times for {} time steps", name, array.name, count, tables.size()));
}

/// PySPH's velocity is u, v and w; its gid tells particles apart where it is set at all.
std::vector<NamedArray> with_usual_names(std::vector<NamedArray> arrays) {
  const auto find = [&](const char* name) {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const NamedArray& array) { return array.name == name; });
    return found == arrays.end() ? nullptr : &*found;
  };
  NamedArray *u = find("u"), *v = find("v"), *w = find("w"), *gid = find("gid");
  if (u != nullptr && v != nullptr && w != nullptr && u->shape == v->shape && v->shape == w->shape &&
      find("vx") == nullptr) {
    u->name = "vx";
    v->name = "vy";
    w->name = "vz";
  }
  const auto has_ids =
      std::any_of(arrays.begin(), arrays.end(), [](const auto& array) { return is_id_name(array.name); });
  if (gid != nullptr && !has_ids &&
      std::adjacent_find(gid->values.begin(), gid->values.end(), std::not_equal_to<>()) != gid->values.end())
    gid->name = "id";
  return arrays;
}

}  // namespace

std::uint64_t entries_of(const std::vector<std::uint64_t>& shape) {
  std::uint64_t entries = 1;
  for (const std::uint64_t length : shape) {
    if (length == 0 || entries > std::numeric_limits<std::uint32_t>::max() * std::uint64_t{1024} / length) return 0;
    entries *= length;
  }
  return entries;
}

bool have_places(const std::vector<NamedArray>& arrays) { return layout_of(arrays).has_value(); }

std::vector<ParticleTable> tables_from_arrays(const std::vector<NamedArray>& given, const std::string& name) {
  const std::vector<NamedArray> arrays = with_usual_names(given);
  const std::optional<ArrayLayout> layout = layout_of(arrays);
  if (!layout) {
    std::vector<std::string> found;
    for (const NamedArray& array : arrays) found.push_back(fmt::format("{} ({})", array.name, shape_text(array.shape)));
    throw InputError(
        fmt::format("{}: expected the places of particles, as arrays x, y and z or as positions of N x 3; "
                    "there are: {}",
                    name, found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "))));
  }
  // An empty array of many steps is cheap to write.
  std::uint64_t entries = 1;
  for (const NamedArray& array : arrays) entries += array.values.size();
  if (layout->steps == 0 || layout->steps > entries)
    throw InputError(fmt::format("{}: {} time steps of {} particles are none", name, layout->steps, layout->particles));
  std::vector<ParticleTable> tables(layout->steps);
  for (ParticleTable& table : tables) table.count = layout->particles;
  // What is the same in all steps is copied to each, as far as that takes no more memory than the rest.
  std::uint64_t copied = 0;
  for (const NamedArray& array : arrays) {
    const std::optional<ArrayFit> fit = fit_of(array, *layout);
    if (fit && !fit->per_step && layout->steps > 1) copied += layout->steps * array.values.size();
    if (fit && (fit->per_step || copied <= most_array_copies * entries)) add_array(array, *layout, *fit, tables);
    if (!fit) refuse_misfit(array, *layout, tables, name);
    add_times(array, *layout, tables, name);
  }
  return tables;
}

}  // namespace flowskin::scenes
