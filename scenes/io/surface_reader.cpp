// Surfaces that write_surface_ply wrote, read back by the same table of attributes.
#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include "common/errors.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_attributes.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"

namespace flowskin::scenes {
namespace {

/// Coordinates of the triangles' corners. @throws InputError where there are not six finite numbers per triangle.
std::vector<std::array<Vec2f, 3>> read_corners(const PlyFile& ply, const std::string& list, const std::string& file) {
  const auto found = ply.face_lists.find(list);
  if (found == ply.face_lists.end() || found->second.size() != 6 * ply.triangles.size())
    throw InputError(file + ": no list \"" + list +
                     "\" of six numbers per triangle: a surface written by FlowSkin was expected");
  std::vector<std::array<Vec2f, 3>> corners(ply.triangles.size());
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    corners[i / 6][i % 6 / 2][i % 2] = static_cast<float>(found->second[i]);
    if (!std::isfinite(found->second[i]))
      throw InputError(file + ", triangle " + std::to_string(i / 6) + ": \"" + list + "\" is not a finite number");
  }
  return corners;
}

/// The names that a file does not have, in quotes; empty: it has all.
std::string missing(const PlyFile& ply, const std::vector<std::string_view>& names) {
  std::string list;
  for (const std::string_view name : names) {
    const std::string text(name);
    if (!ply.vertex.contains(text)) list += (list.empty() ? "\"" : ", \"") + text + "\"";
  }
  return list;
}

/// Vectors and numbers. @throws InputError where one is no finite number
template <class T>
void read_values(const PlyFile& ply, const std::vector<std::string_view>& names, const std::string& file,
                 std::vector<T>& values) {
  values.resize(ply.vertex_count);
  for (int k = 0; k < components_of<T>; ++k) {
    const std::string name(names[static_cast<std::size_t>(k)]);
    const std::vector<double>& column = ply.vertex.at(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(column[i]))
        throw InputError(file + ", vertex " + std::to_string(i) + ": \"" + name + "\" is not a finite number");
      if constexpr (std::is_arithmetic_v<T>)
        values[i] = static_cast<T>(column[i]);
      else
        values[i][k] = static_cast<std::remove_cvref_t<decltype(values[i][k])>>(column[i]);
    }
  }
}

/// Persistent ids. @throws InputError where one is no whole number, or there twice
std::vector<std::uint64_t> ids_of(const std::vector<double>& column, const std::string& file) {
  std::vector<std::uint64_t> ids(column.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double id = column[i];
    if (!(id >= 0) || id != std::floor(id) || id > 9007199254740992.0)
      throw InputError(file + ", vertex " + std::to_string(i) + ": its id is no whole number from 0 to 2^53");
    ids[i] = static_cast<std::uint64_t>(id);
  }
  std::vector<std::uint64_t> sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) throw InputError(file + ": two vertices have the id " + std::to_string(*twice));
  return ids;
}

/// Reads the attributes of the frame that are wanted. @throws InputError where one that is not optional is missing
template <class Wanted>
void read_attributes(const PlyFile& ply, const std::string& file, const Wanted& wanted, SurfaceFrame& frame) {
  std::string lacking;
  for_each_surface_attribute(frame, [&](const FileAttribute& attribute, auto& values) {
    using T = typename std::remove_cvref_t<decltype(values)>::value_type;
    if (!wanted(attribute)) return;
    if (const std::string list = missing(ply, attribute.ply); !list.empty()) {
      if (!attribute.optional) lacking += (lacking.empty() ? "" : ", ") + list;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      values = ids_of(ply.vertex.at(std::string(attribute.ply.front())), file);
    } else {
      read_values(ply, attribute.ply, file, values);
    }
  });
  if (!lacking.empty())
    throw InputError(file + ": no vertex property " + lacking + ": a surface written by FlowSkin was expected");
}

}  // namespace

std::vector<Vec2f> read_surface_confidence(const std::filesystem::path& file) {
  SurfaceFrame frame;
  read_attributes(
      read_ply(file), file.string(), [](const FileAttribute& a) { return a.vtp == "confidence"; }, frame);
  return frame.confidence;
}

void read_surface_blend(const std::filesystem::path& file, SurfaceFrame& frame) {
  const PlyFile ply = read_ply(file);
  if (!ply.vertex.contains("texture_blend")) return;
  read_attributes(
      ply, file.string(), [](const FileAttribute& a) { return a.vtp == "texture_blend"; }, frame);
  for (const float weight : frame.texture_blend)
    if (!(weight >= 0 && weight <= 1)) throw InputError(file.string() + ": a \"texture_blend\" is not between 0 and 1");
  if (!ply.face_lists.contains("texcoord2")) return;
  frame.corner_uvs = read_corners(ply, "texcoord", file.string());
  frame.corner_uvs2 = read_corners(ply, "texcoord2", file.string());
}

tracking::SurfaceMesh read_surface_ply(const std::filesystem::path& file) {
  const PlyFile ply = read_ply(file);
  SurfaceFrame frame;
  read_attributes(
      ply, file.string(), [](const FileAttribute& a) { return a.of_mesh; }, frame);
  tracking::SurfaceMesh& mesh = frame.mesh;
  mesh.triangles = ply.triangles;
  mesh.next_id = mesh.ids.empty() ? 0 : *std::max_element(mesh.ids.begin(), mesh.ids.end()) + 1;
  return std::move(mesh);
}

}  // namespace flowskin::scenes
