// VTK's PolyData in XML with raw appended data, and ParaView's collections.
#include <concepts>
#include <string>
#include <type_traits>

#include "scenes/io/atomic_file.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_attributes.h"
#include "scenes/io/frame_checks.h"
#include "scenes/io/frame_files.h"

namespace flowskin::scenes {
namespace {

template <class T>
std::string_view vtp_type() {
  if constexpr (std::is_same_v<T, std::uint64_t>) return "UInt64";
  if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, Color>) return "UInt8";
  return "Float32";
}

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

  /// An array of what vertices or particles carry; its type follows from that of the values.
  template <class T>
  void attribute(ByteBuffer& xml, std::string_view name, const std::vector<T>& values) {
    ByteBuffer& data = begin(xml, name, vtp_type<T>(), components_of<T>, values.size(), bytes_of_number<T>);
    for (const T& value : values) data.value(value);
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

template <class Frame>
void add_arrays(const Frame& frame, ByteBuffer& xml, VtpArrays& arrays) {
  for_each_vtp_array(
      frame, [&](const FileAttribute& attribute, const auto& values) { arrays.attribute(xml, attribute.vtp, values); });
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
  add_arrays(frame, xml, arrays);
  xml.text("      </PointData>\n      <Points>\n");
  arrays.attribute(xml, "Points", mesh.positions);
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
  add_arrays(frame, xml, arrays);
  xml.text("      </PointData>\n      <Points>\n");
  arrays.attribute(xml, "Points", state.positions);
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
