// Stanford PLY, binary little-endian: surfaces and particles, and surfaces read back.
#include <algorithm>
#include <cmath>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_checks.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"

namespace flowskin::scenes {
namespace {

/// PLY has no 64-bit integers: ids beyond 32 bits are written as double, exact up to 2^53.
class IdColumn {
 public:
  IdColumn(const std::vector<std::uint64_t>& ids, const std::filesystem::path& file) {
    const std::uint64_t largest = ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
    is_wide_ = largest > UINT32_MAX;
    if (largest > (std::uint64_t{1} << 53))
      throw RunError("cannot write " + file.string() + ": the id " + std::to_string(largest) + " is beyond 2^53");
  }
  std::string_view property() const { return is_wide_ ? "property double id\n" : "property uint id\n"; }
  void add(ByteBuffer& ply, std::uint64_t id) const {
    if (is_wide_)
      ply.f64(static_cast<double>(id));
    else
      ply.u32(static_cast<std::uint32_t>(id));
  }

 private:
  bool is_wide_ = false;
};

void begin_header(ByteBuffer& ply, std::string_view content, double time) {
  ply.text("ply\nformat binary_little_endian 1.0\ncomment FlowSkin ");
  ply.text(content);
  ply.text(", m, s, y up\ncomment time ");
  ply.number(time);
  ply.character('\n');
}

void add_properties(ByteBuffer& ply, std::string_view type, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    ply.text("property ");
    ply.text(type);
    ply.character(' ');
    ply.text(name);
    ply.character('\n');
  }
}

void add_element(ByteBuffer& ply, std::string_view name, std::size_t count) {
  ply.text("element ");
  ply.text(name);
  ply.character(' ');
  ply.number(count);
  ply.character('\n');
}

void add_color(ByteBuffer& ply, const Color& color) {
  for (const std::uint8_t channel : color) ply.byte(channel);
}

void add_vertices(ByteBuffer& ply, const SurfaceFrame& frame, const IdColumn& id_column) {
  const tracking::SurfaceMesh& mesh = frame.mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    ply.vec3(mesh.positions[i]);
    ply.vec3(frame.normals[i]);
    // Twice, since some programs know the coordinates as s and t, others as texture_u and texture_v.
    for (int repeat = 0; repeat < 2; ++repeat) {
      ply.f32(frame.vertex_uvs[i].x());
      ply.f32(frame.vertex_uvs[i].y());
    }
    add_color(ply, frame.colors[i]);
    ply.vec3(mesh.velocities[i]);
    ply.vec3(mesh.rest_positions[i]);
    id_column.add(ply, mesh.ids[i]);
    if (!frame.confidence.empty()) {
      ply.f32(frame.confidence[i].x());
      ply.f32(frame.confidence[i].y());
    }
    for (int repeat = 0; repeat < 2 && !frame.vertex_uvs2.empty(); ++repeat) {
      ply.f32(frame.vertex_uvs2[i].x());
      ply.f32(frame.vertex_uvs2[i].y());
    }
    if (!frame.texture_blend.empty()) ply.f32(frame.texture_blend[i]);
  }
}

void add_corners(ByteBuffer& ply, const std::array<Vec2f, 3>& uvs) {
  ply.byte(6);
  for (const Vec2f& uv : uvs) {
    ply.f32(uv.x());
    ply.f32(uv.y());
  }
}

void add_faces(ByteBuffer& ply, const SurfaceFrame& frame) {
  for (std::size_t i = 0; i < frame.mesh.triangles.size(); ++i) {
    ply.byte(3);
    for (const int vertex : frame.mesh.triangles[i]) ply.i32(vertex);
    add_corners(ply, frame.corner_uvs[i]);
    if (!frame.corner_uvs2.empty()) add_corners(ply, frame.corner_uvs2[i]);
  }
}

/// Two columns, or nothing where the file has none of that name.
std::vector<Vec2f> read_confidence(const PlyFile& ply) {
  const auto weak = ply.vertex.find("confidence"), strong = ply.vertex.find("confidence_strong");
  if (weak == ply.vertex.end() || strong == ply.vertex.end()) return {};
  std::vector<Vec2f> result(ply.vertex_count);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {float(weak->second[i]), float(strong->second[i])};
  return result;
}

/// Coordinates of the triangles' corners. @throws InputError where there are not six finite numbers a triangle.
std::vector<std::array<Vec2f, 3>> read_corners(const PlyFile& ply, const std::string& list, const std::string& file) {
  const auto found = ply.face_lists.find(list);
  if (found == ply.face_lists.end() || found->second.size() != 6 * ply.triangles.size())
    throw InputError(file + ": no list \"" + list + "\" of six numbers a triangle: a surface written by FlowSkin was " +
                     "expected");
  std::vector<std::array<Vec2f, 3>> corners(ply.triangles.size());
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    corners[i / 6][i % 6 / 2][i % 2] = static_cast<float>(found->second[i]);
    if (!std::isfinite(found->second[i]))
      throw InputError(file + ", triangle " + std::to_string(i / 6) + ": \"" + list + "\" is not a finite number");
  }
  return corners;
}

/// Three float columns as vectors. @throws InputError where one is missing or holds no finite number.
std::vector<Vec3> read_vectors(const PlyFile& ply, const std::array<const char*, 3>& names, const std::string& file) {
  std::vector<Vec3> result(ply.vertex_count);
  for (int k = 0; k < 3; ++k) {
    const auto column = ply.vertex.find(names[k]);
    if (column == ply.vertex.end())
      throw InputError(file + ": no vertex property \"" + names[k] + "\": a surface written by FlowSkin was expected");
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i][k] = column->second[i];
      if (!std::isfinite(result[i][k]))
        throw InputError(file + ", vertex " + std::to_string(i) + ": \"" + names[k] + "\" is not a finite number");
    }
  }
  return result;
}

std::vector<std::uint64_t> read_ids(const PlyFile& ply, const std::string& file) {
  const auto column = ply.vertex.find("id");
  if (column == ply.vertex.end())
    throw InputError(file + ": no vertex property \"id\": a surface written by FlowSkin was expected");
  std::vector<std::uint64_t> ids(ply.vertex_count);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double id = column->second[i];
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

}  // namespace

void write_surface_ply(const std::filesystem::path& file, const SurfaceFrame& frame) {
  check_frame(frame, file);
  const IdColumn id_column(frame.mesh.ids, file);
  ByteBuffer ply;
  ply.reserve(2000 + 80 * frame.mesh.positions.size() + 38 * frame.mesh.triangles.size());
  begin_header(ply, "surface", frame.time);
  // MeshLab finds the image of the texture coordinates by this comment.
  if (!frame.texture_file.empty()) ply.text("comment TextureFile " + frame.texture_file + "\n");
  add_element(ply, "vertex", frame.mesh.positions.size());
  add_properties(ply, "float", {"x", "y", "z", "nx", "ny", "nz", "s", "t", "texture_u", "texture_v"});
  add_properties(ply, "uchar", {"red", "green", "blue"});
  add_properties(ply, "float", {"vx", "vy", "vz", "rest_x", "rest_y", "rest_z"});
  ply.text(id_column.property());
  if (!frame.confidence.empty()) add_properties(ply, "float", {"confidence", "confidence_strong"});
  if (!frame.vertex_uvs2.empty()) add_properties(ply, "float", {"s2", "t2", "texture_u2", "texture_v2"});
  if (!frame.texture_blend.empty()) add_properties(ply, "float", {"texture_blend"});
  add_element(ply, "face", frame.mesh.triangles.size());
  ply.text("property list uchar int vertex_indices\nproperty list uchar float texcoord\n");
  if (!frame.corner_uvs2.empty()) ply.text("property list uchar float texcoord2\n");
  ply.text("end_header\n");
  add_vertices(ply, frame, id_column);
  add_faces(ply, frame);
  write_file(file, ply.view());
}

void write_particles_ply(const std::filesystem::path& file, const ParticleFrame& frame) {
  check_frame(frame, file);
  const ParticleState& state = frame.state;
  const IdColumn id_column(state.ids, file);
  ByteBuffer ply;
  ply.reserve(2000 + 61 * state.positions.size());
  begin_header(ply, "particles", state.time);
  ply.text("comment radius ");
  ply.number(frame.radius);
  ply.character('\n');
  add_element(ply, "vertex", state.positions.size());
  add_properties(ply, "float", {"x", "y", "z", "vx", "vy", "vz", "density", "rest_x", "rest_y", "rest_z"});
  ply.text(id_column.property());
  add_properties(ply, "uchar", {"red", "green", "blue"});
  if (!state.fluids.empty()) add_properties(ply, "uchar", {"fluid"});
  if (!state.viscosities.empty()) add_properties(ply, "float", {"viscosity"});
  ply.text("end_header\n");
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    ply.vec3(state.positions[i]);
    ply.vec3(state.velocities[i]);
    ply.f32(static_cast<float>(state.densities[i]));
    ply.vec3(state.rest_positions[i]);
    id_column.add(ply, state.ids[i]);
    add_color(ply, frame.colors[i]);
    if (!state.fluids.empty()) ply.byte(state.fluids[i]);
    if (!state.viscosities.empty()) ply.f32(state.viscosities[i]);
  }
  write_file(file, ply.view());
}

std::vector<Vec2f> read_surface_confidence(const std::filesystem::path& file) {
  return read_confidence(read_ply(file));
}

void read_surface_blend(const std::filesystem::path& file, SurfaceFrame& frame) {
  const PlyFile ply = read_ply(file);
  const auto blend = ply.vertex.find("texture_blend");
  if (blend == ply.vertex.end()) return;
  frame.texture_blend.assign(blend->second.begin(), blend->second.end());
  for (const float weight : frame.texture_blend)
    if (!(weight >= 0 && weight <= 1)) throw InputError(file.string() + ": a \"texture_blend\" is not between 0 and 1");
  if (!ply.face_lists.contains("texcoord2")) return;
  frame.corner_uvs = read_corners(ply, "texcoord", file.string());
  frame.corner_uvs2 = read_corners(ply, "texcoord2", file.string());
}

tracking::SurfaceMesh read_surface_ply(const std::filesystem::path& file) {
  const std::string name = file.string();
  const PlyFile ply = read_ply(file);
  tracking::SurfaceMesh mesh;
  mesh.positions = read_vectors(ply, {"x", "y", "z"}, name);
  mesh.rest_positions = read_vectors(ply, {"rest_x", "rest_y", "rest_z"}, name);
  mesh.velocities = read_vectors(ply, {"vx", "vy", "vz"}, name);
  mesh.ids = read_ids(ply, name);
  mesh.triangles = ply.triangles;
  mesh.next_id = mesh.ids.empty() ? 0 : *std::max_element(mesh.ids.begin(), mesh.ids.end()) + 1;
  return mesh;
}

}  // namespace flowskin::scenes
