// VTK's PolyData in XML with raw appended data, and ParaView's collections.
#include <concepts>
#include <string>

#include "scenes/io/atomic_file.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_checks.h"
#include "scenes/io/frame_files.h"

namespace flowskin::scenes {
namespace {

/// Collects arrays: their descriptions as XML, their values one after the other, each led by its length in bytes.
class VtpArrays {
 public:
  /// Starts an array of `tuples` times `components` values of `value_size` bytes; its values are to be added to data().
  ByteBuffer& begin(ByteBuffer& xml, std::string_view name, std::string_view type, int components, std::size_t tuples,
                    std::size_t value_size) {
    xml.text("        <DataArray type=\"");
    xml.text(type);
    xml.text("\" Name=\"");
    xml.text(name);
    xml.text("\" NumberOfComponents=\"");
    xml.number(components);
    xml.text("\" format=\"appended\" offset=\"");
    xml.number(data_.size());
    xml.text("\"/>\n");
    data_.u64(static_cast<std::uint64_t>(tuples * static_cast<std::size_t>(components) * value_size));
    return data_;
  }

  template <class Vector>
  void vectors(ByteBuffer& xml, std::string_view name, const std::vector<Vector>& values) {
    ByteBuffer& data = begin(xml, name, "Float32", 3, values.size(), 4);
    for (const Vector& v : values) data.vec3(v);
  }
  void pairs(ByteBuffer& xml, std::string_view name, const std::vector<Vec2f>& values) {
    ByteBuffer& data = begin(xml, name, "Float32", 2, values.size(), 4);
    for (const Vec2f& v : values) {
      data.f32(v.x());
      data.f32(v.y());
    }
  }
  void colors(ByteBuffer& xml, const std::vector<Color>& values) {
    ByteBuffer& data = begin(xml, "color", "UInt8", 3, values.size(), 1);
    for (const Color& color : values)
      for (const std::uint8_t channel : color) data.byte(channel);
  }
  void ids(ByteBuffer& xml, const std::vector<std::uint64_t>& values) {
    ByteBuffer& data = begin(xml, "id", "UInt64", 1, values.size(), 8);
    for (const std::uint64_t id : values) data.u64(id);
  }
  /// Cells of `corners` points each; `point(i)` is the i-th of all their points.
  void cells(ByteBuffer& xml, std::size_t count, int corners, std::invocable<std::size_t> auto point) {
    const std::size_t points = count * static_cast<std::size_t>(corners);
    ByteBuffer& connectivity = begin(xml, "connectivity", "Int32", 1, points, 4);
    for (std::size_t i = 0; i < points; ++i) connectivity.i32(point(i));
    ByteBuffer& offsets = begin(xml, "offsets", "Int32", 1, count, 4);
    for (std::size_t i = 0; i < count; ++i) offsets.i32(static_cast<int>(i + 1) * corners);
  }

  std::string_view data() const { return data_.view(); }

 private:
  ByteBuffer data_;
};

void begin_piece(ByteBuffer& xml, double time, std::size_t points, std::size_t vertices, std::size_t polygons) {
  xml.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PolyData>\n"
      "    <FieldData>\n"
      "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">");
  xml.number(time);
  xml.text("</DataArray>\n    </FieldData>\n    <Piece NumberOfPoints=\"");
  xml.number(points);
  xml.text("\" NumberOfVerts=\"");
  xml.number(vertices);
  xml.text("\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"");
  xml.number(polygons);
  xml.text("\">\n");
}

void finish(const std::filesystem::path& file, ByteBuffer& xml, const VtpArrays& arrays) {
  xml.text("    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  xml.text(arrays.data());
  xml.text("\n  </AppendedData>\n</VTKFile>\n");
  write_file(file, xml.view());
}

/// Text inside an attribute of XML.
std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace

void write_surface_vtp(const std::filesystem::path& file, const SurfaceFrame& frame) {
  check_frame(frame, file);
  const tracking::SurfaceMesh& mesh = frame.mesh;
  ByteBuffer xml;
  VtpArrays arrays;
  begin_piece(xml, frame.time, mesh.positions.size(), 0, mesh.triangles.size());
  xml.text("      <PointData Normals=\"Normals\" TCoords=\"TCoords\" Scalars=\"color\" Vectors=\"velocity\">\n");
  arrays.vectors(xml, "Normals", frame.normals);
  arrays.pairs(xml, "TCoords", frame.vertex_uvs);
  arrays.colors(xml, frame.colors);
  arrays.vectors(xml, "velocity", mesh.velocities);
  arrays.vectors(xml, "rest_position", mesh.rest_positions);
  arrays.ids(xml, mesh.ids);
  if (!frame.confidence.empty()) arrays.pairs(xml, "confidence", frame.confidence);
  if (!frame.vertex_uvs2.empty()) arrays.pairs(xml, "TCoords2", frame.vertex_uvs2);
  if (!frame.texture_blend.empty()) {
    ByteBuffer& weights = arrays.begin(xml, "texture_blend", "Float32", 1, frame.texture_blend.size(), 4);
    for (const float weight : frame.texture_blend) weights.f32(weight);
  }
  xml.text("      </PointData>\n      <Points>\n");
  arrays.vectors(xml, "Points", mesh.positions);
  xml.text("      </Points>\n      <Polys>\n");
  arrays.cells(xml, mesh.triangles.size(), 3, [&mesh](std::size_t i) { return mesh.triangles[i / 3][i % 3]; });
  xml.text("      </Polys>\n");
  finish(file, xml, arrays);
}

void write_particles_vtp(const std::filesystem::path& file, const ParticleFrame& frame) {
  check_frame(frame, file);
  const ParticleState& state = frame.state;
  ByteBuffer xml;
  VtpArrays arrays;
  begin_piece(xml, state.time, state.positions.size(), state.positions.size(), 0);
  xml.text("      <PointData Scalars=\"color\" Vectors=\"velocity\">\n");
  arrays.colors(xml, frame.colors);
  arrays.vectors(xml, "velocity", state.velocities);
  arrays.vectors(xml, "rest_position", state.rest_positions);
  ByteBuffer& densities = arrays.begin(xml, "density", "Float32", 1, state.densities.size(), 4);
  for (const double density : state.densities) densities.f32(static_cast<float>(density));
  if (!state.fluids.empty()) {
    ByteBuffer& fluids = arrays.begin(xml, "fluid", "UInt8", 1, state.fluids.size(), 1);
    for (const std::uint8_t fluid : state.fluids) fluids.byte(fluid);
  }
  if (!state.viscosities.empty()) {
    ByteBuffer& viscosities = arrays.begin(xml, "viscosity", "Float32", 1, state.viscosities.size(), 4);
    for (const float viscosity : state.viscosities) viscosities.f32(viscosity);
  }
  arrays.ids(xml, state.ids);
  xml.text("      </PointData>\n      <Points>\n");
  arrays.vectors(xml, "Points", state.positions);
  xml.text("      </Points>\n      <Verts>\n");
  arrays.cells(xml, state.positions.size(), 1, [](std::size_t i) { return static_cast<int>(i); });
  xml.text("      </Verts>\n");
  finish(file, xml, arrays);
}

void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& entries) {
  ByteBuffer xml;
  xml.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n");
  for (const auto& [time, name] : entries) {
    xml.text("    <DataSet timestep=\"");
    xml.number(time);
    xml.text("\" group=\"\" part=\"0\" file=\"" + escape(name) + "\"/>\n");
  }
  xml.text("  </Collection>\n</VTKFile>\n");
  write_file(file, xml.view());
}

}  // namespace flowskin::scenes
