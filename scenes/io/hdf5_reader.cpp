#include "scenes/io/hdf5_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "common/errors.h"
#include "scenes/io/hdf5_file.h"
#include "scenes/io/named_arrays.h"
#include "scenes/io/particle_columns.h"
#include "scenes/sources/name_order.h"

namespace flowskin::scenes {
namespace {

using Groups = std::vector<Hdf5File::Group>;

std::string parent_of(const std::string& path) { return path.substr(0, path.rfind('/')); }
std::string last_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Groups that hold places.
Groups groups_of_particles(const Groups& all) {
  Groups found;
  std::copy_if(all.begin(), all.end(), std::back_inserter(found),
               [](const Hdf5File::Group& group) { return have_places(group.arrays); });
  return found;
}

/// Groups that are numbered, one a step, in their order; none where they are not. Those of Gadget have the numbers of
/// kinds of particles.
Groups steps_in_order(const Groups& groups) {
  if (last_name(groups.front().path).starts_with("PartType")) return {};
  std::vector<std::string> names;
  for (const Hdf5File::Group& group : groups) {
    names.push_back(last_name(group.path));
    if (parent_of(group.path) != parent_of(groups.front().path)) return {};
  }
  const NameOrder order = order_of_names(names);
  if (order.numbers.empty() || order.twins) return {};
  Groups sorted;
  for (const std::size_t k : order.order) sorted.push_back(groups[k]);
  return sorted;
}

bool is_fluid(const Hdf5File::Group& group) {
  return (group.path + "/").find("/fluid/") != std::string::npos || group.path == "/PartType0";
}

/// Attributes of points stand in a group of their own beside the points in VTKHDF.
void add_point_data(const Groups& all, Hdf5File::Group& group, const Hdf5File& file, std::vector<NamedArray>& arrays) {
  for (const Hdf5File::Group& other : all) {
    if (other.path != group.path + "/PointData") continue;
    for (NamedArray array : other.arrays) {
      file.read(other, array);
      arrays.push_back(std::move(array));
    }
  }
}

/// Faces of a mesh in VTKHDF.
std::size_t polygons_in(const Groups& all, const std::string& path) {
  std::size_t polygons = 0;
  for (const Hdf5File::Group& other : all)
    for (const NamedArray& array : other.arrays)
      if ((other.path == path + "/Polygons" || other.path == path + "/Strips") && array.name == "Offsets")
        polygons += entries_of(array.shape) > 0 ? entries_of(array.shape) - 1 : 0;
  return polygons;
}

/// The time of a file of one step: of the group, of those around it, or of a group that holds nothing else.
std::optional<double> time_of_file(const Groups& all, const Hdf5File::Group& group, const Hdf5File& file) {
  if (group.time) return group.time;
  for (const Hdf5File::Group& other : all) {
    const bool is_around = group.path.starts_with(other.path == "/" ? "/" : other.path + "/");
    const bool tells = is_around || other.path == "/solver_data" || other.path == "/Header";
    if (tells && other.time) return other.time;
    for (NamedArray array : other.arrays) {
      if (!tells || !array.shape.empty() || (array.name != "t" && array.name != "time")) continue;
      file.read(other, array);
      return array.values.front();
    }
  }
  return std::nullopt;
}

class Hdf5Particles {
 public:
  Hdf5Particles(std::string_view bytes, const std::string& name)
      : name_(name), file_(bytes, name), all_(file_.groups()), found_(groups_of_particles(all_)) {}

  std::vector<ParticleTable> read() {
    if (found_.empty()) fail_without_places();
    for (const Hdf5File::Group& group : all_)
      if (last_name(group.path) == "Steps" && parent_of(group.path) == found_.front().path)
        throw InputError(name_ +
                         ": a VTKHDF file of many time steps; save one file a step (ParaView: File > Save Data, "
                         ".vtp, all time steps)");
    if (found_.size() == 1) return tables_of(found_.front());
    if (const Groups steps = steps_in_order(found_); !steps.empty()) return tables_of_steps(steps);
    Groups fluids;
    std::copy_if(found_.begin(), found_.end(), std::back_inserter(fluids), is_fluid);
    if (fluids.size() == 1) return tables_of(fluids.front());
    std::vector<std::string> paths;
    for (const Hdf5File::Group& group : found_) paths.push_back(group.path);
    paths.resize(std::min<std::size_t>(paths.size(), 20));
    throw InputError(
        fmt::format("{}: there are several groups of particles ({}), and none is called fluid; copy the one "
                    "that counts: h5copy -i IN -o OUT -s {} -d /fluid",
                    name_, fmt::join(paths, ", "), paths.front()));
  }

 private:
  [[noreturn]] void fail_without_places() const {
    std::vector<std::string> names;
    for (const Hdf5File::Group& group : all_)
      for (const NamedArray& array : group.arrays)
        if (names.size() < 20) names.push_back(group.path + ": " + array.name);
    throw InputError(
        fmt::format("{}: no group of the HDF5 file holds places of particles, as arrays x, y and z or as "
                    "positions of N x 3; there are {}",
                    name_, names.empty() ? "no arrays" : fmt::format("{}", fmt::join(names, ", "))));
  }

  std::vector<ParticleTable> tables_of(Hdf5File::Group& group) const {
    std::vector<NamedArray> arrays = group.arrays;
    for (NamedArray& array : arrays) file_.read(group, array);
    add_point_data(all_, group, file_, arrays);
    std::vector<ParticleTable> tables = tables_from_arrays(arrays, name_);
    for (ParticleTable& table : tables) {
      table.format = found_.size() == 1 ? "HDF5" : fmt::format("HDF5, {} of {} groups", group.path, found_.size());
      table.polygons = polygons_in(all_, group.path);
    }
    if (tables.size() == 1 && !tables.front().time) tables.front().time = time_of_file(all_, group, file_);
    return tables;
  }

  std::vector<ParticleTable> tables_of_steps(Groups steps) const {
    std::vector<ParticleTable> tables;
    for (Hdf5File::Group& group : steps) {
      std::vector<ParticleTable> step = tables_of(group);
      if (step.size() > 1) throw InputError(fmt::format("{}: {} holds steps within steps", name_, group.path));
      step.front().time = group.time;
      tables.push_back(std::move(step.front()));
    }
    return tables;
  }

  const std::string& name_;
  Hdf5File file_;
  Groups all_, found_;
};

}  // namespace

bool is_hdf5(std::string_view bytes) { return bytes.starts_with("\x89HDF\r\n\x1a\n"); }

std::vector<ParticleTable> parse_hdf5(std::string_view bytes, const std::string& name) {
  return Hdf5Particles(bytes, name).read();
}

}  // namespace flowskin::scenes
