// Stanford PLY, binary little-endian: surfaces and particles.
#include <algorithm>
#include <functional>
#include <type_traits>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_attributes.h"
#include "scenes/io/frame_checks.h"
#include "scenes/io/frame_files.h"

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

void add_properties(ByteBuffer& ply, std::string_view type, const std::vector<std::string_view>& names) {
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

/// The type of an attribute's numbers in a PLY file; ids have a column of their own.
template <class T>
constexpr std::string_view ply_type() {
  return std::is_same_v<T, std::uint8_t> || std::is_same_v<T, Color> ? "uchar" : "float";
}

template <class Frame>
void add_attribute_properties(ByteBuffer& ply, const Frame& frame, const IdColumn& id_column) {
  for_each_file_attribute(frame, [&](const FileAttribute& attribute, const auto& values) {
    using T = typename std::remove_cvref_t<decltype(values)>::value_type;
    if (attribute.optional && values.empty()) return;
    if constexpr (std::is_same_v<T, std::uint64_t>)
      ply.text(id_column.property());
    else
      add_properties(ply, ply_type<T>(), attribute.ply);
  });
}

/// One column or a few: what is written of an item.
using ItemColumns = std::vector<std::function<void(std::size_t)>>;

template <class Frame>
ItemColumns columns_of(ByteBuffer& ply, const Frame& frame, const IdColumn& id_column) {
  ItemColumns columns;
  for_each_file_attribute(frame, [&](const FileAttribute& attribute, const auto& values) {
    using T = typename std::remove_cvref_t<decltype(values)>::value_type;
    if (attribute.optional && values.empty()) return;
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      columns.push_back([&](std::size_t i) { id_column.add(ply, values[i]); });
    } else {
      const std::size_t times = attribute.ply.size() / components_of<T>;
      columns.push_back([&ply, &values, times](std::size_t i) {
        for (std::size_t k = 0; k < times; ++k) ply.value(values[i]);
      });
    }
  });
  return columns;
}

/// All items, one after the other.
template <class Frame>
void add_items(ByteBuffer& ply, const Frame& frame, std::size_t count, const IdColumn& id_column) {
  const ItemColumns columns = columns_of(ply, frame, id_column);
  for (std::size_t i = 0; i < count; ++i)
    for (const auto& add : columns) add(i);
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
  add_attribute_properties(ply, frame, id_column);
  add_element(ply, "face", frame.mesh.triangles.size());
  ply.text("property list uchar int vertex_indices\nproperty list uchar float texcoord\n");
  if (!frame.corner_uvs2.empty()) ply.text("property list uchar float texcoord2\n");
  ply.text("end_header\n");
  add_items(ply, frame, frame.mesh.positions.size(), id_column);
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
  add_attribute_properties(ply, frame, id_column);
  ply.text("end_header\n");
  add_items(ply, frame, state.positions.size(), id_column);
  write_file(file, ply.view());
}

}  // namespace flowskin::scenes
