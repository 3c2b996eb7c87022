#include "scenes/io/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

constexpr int most_hdf5_levels = 16;
constexpr std::size_t most_hdf5_groups = 100000;
/// Bytes of numbers for each byte of the file; arrays that were never written are of any size.
constexpr std::uint64_t most_hdf5_growth = 400, always_allowed_hdf5 = 1 << 20;

/// What the library hands out, closed at the end.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool is_open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

std::string joined(const std::string& path, const std::string& name) {
  return path == "/" ? path + name : path + "/" + name;
}

/// Names of the members of a group that are there themselves and no links.
std::vector<std::string> members_of(hid_t group) {
  std::vector<std::string> names;
  hsize_t index = 0;
  const auto visit = [](hid_t, const char* name, const H5L_info_t* info, void* list) -> herr_t {
    auto& all = *static_cast<std::vector<std::string>*>(list);
    if (info->type == H5L_TYPE_HARD) all.emplace_back(name);
    return all.size() > most_hdf5_groups ? 1 : 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &index, visit, &names);
  return names;
}

/// A number in an attribute that tells the time.
std::optional<double> time_of(hid_t group) {
  for (const char* name : {"time", "Time", "TIME", "TimeValue", "t"}) {
    if (H5Aexists(group, name) <= 0) continue;
    const Hdf5Handle attribute(H5Aopen(group, name, H5P_DEFAULT), H5Aclose);
    if (!attribute.is_open()) continue;
    const Hdf5Handle space(H5Aget_space(attribute.get()), H5Sclose), type(H5Aget_type(attribute.get()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    double value = 0;
    if (H5Sget_simple_extent_npoints(space.get()) == 1 && (kind == H5T_FLOAT || kind == H5T_INTEGER) &&
        H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0)
      return value;
  }
  return std::nullopt;
}

/// The library works on what is damaged without a word to standard error, and loads no code.
void quiet_library() {
  static const bool done = [] {
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace

Hdf5File::Hdf5File(std::string_view bytes, const std::string& name) : image_(bytes), name_(name) {
  quiet_library();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t growth = 1 << 16;
  H5Pset_fapl_core(access.get(), growth, 0);
  H5Pset_file_image(access.get(), image_.data(), image_.size());
  file_ = H5Fopen("in memory", H5F_ACC_RDONLY, access.get());
  if (file_ < 0) throw InputError(name + ": the HDF5 file is truncated or damaged");
}

Hdf5File::~Hdf5File() { H5Fclose(file_); }

std::vector<Hdf5File::Group> Hdf5File::groups() const {
  std::vector<Group> all;
  add_group("/", 0, all);
  return all;
}

void Hdf5File::add_group(const std::string& path, int level, std::vector<Group>& groups) const {
  if (level > most_hdf5_levels || groups.size() > most_hdf5_groups) return;
  const Hdf5Handle group(H5Gopen2(file_, path.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.is_open()) return;
  const std::size_t place = groups.size();
  groups.push_back({path, {}, time_of(group.get())});
  for (const std::string& member : members_of(group.get())) {
    H5O_info_t info;
    if (H5Oget_info_by_name2(group.get(), member.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0) continue;
    if (info.type == H5O_TYPE_GROUP) add_group(joined(path, member), level + 1, groups);
    if (info.type != H5O_TYPE_DATASET) continue;
    if (auto array = described(path, member)) groups[place].arrays.push_back(std::move(*array));
  }
}

std::optional<NamedArray> Hdf5File::described(const std::string& path, const std::string& array) const {
  const Hdf5Handle data(H5Dopen2(file_, joined(path, array).c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.is_open()) return std::nullopt;
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose), space(H5Dget_space(data.get()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) return std::nullopt;
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  const int rank = H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  if (rank < 0) return std::nullopt;
  NamedArray result{array, {lengths.begin(), lengths.begin() + rank}, {}, {}};
  const std::uint64_t entries = result.shape.empty() ? 1 : entries_of(result.shape);
  if (entries > (always_allowed_hdf5 + most_hdf5_growth * image_.size()) / sizeof(double)) return std::nullopt;
  // What stands in other files is not looked for.
  const Hdf5Handle layout(H5Dget_create_plist(data.get()), H5Pclose);
  if (H5Pget_external_count(layout.get()) > 0 || H5Pget_layout(layout.get()) == H5D_VIRTUAL) return std::nullopt;
  return result;
}

void Hdf5File::read(const Group& group, NamedArray& array) const {
  const auto check = [&](herr_t status) {
    if (status < 0)
      throw InputError(
          fmt::format("{}: the array {} cannot be read: it is damaged, or compressed by a method that "
                      "HDF5 does not bring along (h5repack -f GZIP=5 IN OUT changes that)",
                      name_, joined(group.path, array.name)));
  };
  const Hdf5Handle data(H5Dopen2(file_, joined(group.path, array.name).c_str(), H5P_DEFAULT), H5Dclose);
  check(data.is_open() ? 0 : -1);
  const std::uint64_t entries = array.shape.empty() ? 1 : entries_of(array.shape);
  array.values.resize(entries);
  if (entries == 0) return;
  check(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()));
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_INTEGER) return;
  array.whole.resize(entries);
  const bool is_signed = H5Tget_sign(type.get()) == H5T_SGN_2;
  check(H5Dread(data.get(), is_signed ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                array.whole.data()));
}

}  // namespace flowskin::scenes
