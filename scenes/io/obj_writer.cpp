// Wavefront OBJ and MTL.
#include "scenes/io/atomic_file.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_checks.h"
#include "scenes/io/frame_files.h"

namespace flowskin::scenes {
namespace {

/// Texture coordinates of all corners, equal ones at the same vertex kept once.
struct SharedUvs {
  std::vector<Vec2f> uvs;
  std::vector<std::array<int, 3>> corners;  ///< index into uvs of each corner of each triangle
};

/// A vertex has as many coordinates as charts of the texture meet there: mostly one, seldom more than three. So each
/// vertex keeps a short chain of them, and no hash table is needed.
SharedUvs share_uvs(const SurfaceFrame& frame) {
  SharedUvs shared;
  std::vector<int> first(frame.mesh.positions.size(), -1);
  std::vector<int> next;
  shared.uvs.reserve(first.size());
  shared.corners.reserve(frame.mesh.triangles.size());
  for (std::size_t i = 0; i < frame.mesh.triangles.size(); ++i) {
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      const Vec2f& uv = frame.corner_uvs[i][k];
      const int vertex = frame.mesh.triangles[i][k];
      int found = first[vertex];
      while (found >= 0 && shared.uvs[found] != uv) found = next[found];
      if (found < 0) {
        found = static_cast<int>(shared.uvs.size());
        shared.uvs.push_back(uv);
        next.push_back(first[vertex]);
        first[vertex] = found;
      }
      corners[k] = found;
    }
    shared.corners.push_back(corners);
  }
  return shared;
}

template <int size, class Vector>
void add_line(ByteBuffer& obj, std::string_view keyword, const Vector& values) {
  obj.text(keyword);
  for (int k = 0; k < size; ++k) {
    obj.character(' ');
    obj.number(static_cast<float>(values[k]));
  }
  obj.character('\n');
}

}  // namespace

void write_surface_obj(const std::filesystem::path& file, const SurfaceFrame& frame, const std::string& material_file) {
  check_frame(frame, file);
  const tracking::SurfaceMesh& mesh = frame.mesh;
  const SharedUvs shared = share_uvs(frame);
  ByteBuffer obj;
  obj.reserve(1000 + 70 * mesh.positions.size() + 24 * shared.uvs.size() + 64 * mesh.triangles.size());
  obj.text("# FlowSkin surface, m, y up\n# time ");
  obj.number(frame.time);
  obj.text(" s\nmtllib " + material_file + "\no surface\n");
  for (const Vec3& x : mesh.positions) add_line<3>(obj, "v", x);
  for (const Vec2f& uv : shared.uvs) add_line<2>(obj, "vt", uv);
  for (const Vec3& n : frame.normals) add_line<3>(obj, "vn", n);
  obj.text("usemtl fluid\ns 1\n");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    obj.character('f');
    for (int k = 0; k < 3; ++k) {
      obj.character(' ');
      obj.number(mesh.triangles[i][k] + 1);
      obj.character('/');
      obj.number(shared.corners[i][k] + 1);
      obj.character('/');
      obj.number(mesh.triangles[i][k] + 1);
    }
    obj.character('\n');
  }
  write_file(file, obj.view());
}

void write_material(const std::filesystem::path& file, const std::string& texture_file) {
  write_file(file,
             "# FlowSkin material\nnewmtl fluid\nKa 0 0 0\nKd 1 1 1\nKs 0.2 0.2 0.2\nNs 60\nd 1\nillum 2\nmap_Kd " +
                 texture_file + "\n");
}

}  // namespace flowskin::scenes
