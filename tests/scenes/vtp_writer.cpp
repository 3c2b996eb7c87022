#include <cstring>

#include "common/errors.h"
#include "scenes/io/frame_files.h"
#include "tests/scenes/io_fixture.h"

namespace flowskin::scenes::vtp_writer_test {
namespace {

/// A VTP file taken apart by hand, as the VTK file formats document describes it.
class Vtp {
 public:
  explicit Vtp(std::string bytes) : bytes_(std::move(bytes)) {
    const std::size_t appended = bytes_.find("<AppendedData encoding=\"raw\">");
    data_ = bytes_.find('_', appended) + 1;
    xml_ = bytes_.substr(0, appended);
    end_ = bytes_.find("\n  </AppendedData>\n</VTKFile>\n", data_);
  }

  /// The value of an attribute of the first tag that starts with `tag`.
  std::string attribute(const std::string& tag, const std::string& name) const {
    const std::size_t start = xml_.find("<" + tag);
    if (start == std::string::npos) return "no such tag";
    const std::string text = xml_.substr(start, xml_.find('>', start) - start);
    const std::size_t value = text.find(" " + name + "=\"") + name.size() + 3;
    return text.substr(value, text.find('"', value) - value);
  }
  std::string array_attribute(const std::string& array, const std::string& name) const {
    const std::size_t start = xml_.rfind('<', xml_.find("Name=\"" + array + "\""));
    return Vtp(xml_.substr(start) + "<AppendedData encoding=\"raw\">_").attribute("DataArray", name);
  }

  template <class T>
  std::vector<T> values(const std::string& array) const {
    std::size_t at = data_ + std::stoul(array_attribute(array, "offset"));
    std::uint64_t size = 0;
    std::memcpy(&size, bytes_.data() + at, 8);
    at += 8;
    EXPECT_LE(at + size, end_) << array;
    covered_ += 8 + size;
    std::vector<T> values(size / sizeof(T));
    if (size > 0) std::memcpy(values.data(), bytes_.data() + at, size);
    return values;
  }
  /// True where the arrays asked for so far make up all of the data.
  bool is_all_covered() const { return data_ + covered_ == end_; }

 private:
  std::string bytes_, xml_;
  std::size_t data_ = 0, end_ = 0;
  mutable std::size_t covered_ = 0;
};

class VtpWriterTest : public IoTest {};

template <class Vector>
void expect_equal(const std::vector<float>& read, const std::vector<Vector>& written, int components) {
  ASSERT_EQ(read.size(), written.size() * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < read.size(); ++i)
    EXPECT_EQ(read[i], static_cast<float>(written[i / components][i % components])) << i;
}

TEST_F(VtpWriterTest, SurfaceArraysAreWhereTheHeaderSays) {
  const SurfaceFrame frame = sphere_frame(2);
  write_surface_vtp(path("a.vtp"), frame);
  const Vtp vtp(read_text(path("a.vtp")));
  EXPECT_EQ(vtp.attribute("VTKFile", "header_type"), "UInt64");
  EXPECT_EQ(vtp.attribute("VTKFile", "byte_order"), "LittleEndian");
  EXPECT_EQ(vtp.attribute("Piece", "NumberOfPoints"), std::to_string(frame.mesh.positions.size()));
  EXPECT_EQ(vtp.attribute("Piece", "NumberOfPolys"), std::to_string(frame.mesh.triangles.size()));
  EXPECT_EQ(vtp.attribute("PointData", "TCoords"), "TCoords");
  EXPECT_EQ(vtp.array_attribute("TCoords", "NumberOfComponents"), "2");
  EXPECT_EQ(vtp.array_attribute("color", "type"), "UInt8");
  expect_equal(vtp.values<float>("Points"), frame.mesh.positions, 3);
  expect_equal(vtp.values<float>("Normals"), frame.normals, 3);
  expect_equal(vtp.values<float>("TCoords"), frame.vertex_uvs, 2);
  expect_equal(vtp.values<float>("velocity"), frame.mesh.velocities, 3);
  expect_equal(vtp.values<float>("rest_position"), frame.mesh.rest_positions, 3);
  EXPECT_EQ(vtp.values<std::uint64_t>("id"), frame.mesh.ids);
  const std::vector<std::uint8_t> colors = vtp.values<std::uint8_t>("color");
  EXPECT_EQ(0, std::memcmp(colors.data(), frame.colors.data(), colors.size()));
  EXPECT_EQ(colors.size(), 3 * frame.colors.size());
  const std::vector<std::int32_t> points = vtp.values<std::int32_t>("connectivity");
  const std::vector<std::int32_t> offsets = vtp.values<std::int32_t>("offsets");
  ASSERT_EQ(points.size(), 3 * frame.mesh.triangles.size());
  ASSERT_EQ(offsets.size(), frame.mesh.triangles.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    EXPECT_EQ(offsets[i], static_cast<int>(3 * i + 3));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(points[3 * i + k], frame.mesh.triangles[i][k]);
  }
  EXPECT_TRUE(vtp.is_all_covered());
}

TEST_F(VtpWriterTest, BlendedTexturesHaveTwoSetsAndAWeight) {
  SurfaceFrame frame = sphere_frame(2);
  for (const Vec2f& uv : frame.vertex_uvs) {
    frame.vertex_uvs2.push_back(2 * uv + Vec2f(1, 0));
    frame.texture_blend.push_back(1 / (1 + uv.squaredNorm()));
  }
  frame.corner_uvs2 = frame.corner_uvs;
  write_surface_vtp(path("a.vtp"), frame);
  const Vtp vtp(read_text(path("a.vtp")));
  expect_equal(vtp.values<float>("TCoords"), frame.vertex_uvs, 2);
  expect_equal(vtp.values<float>("TCoords2"), frame.vertex_uvs2, 2);
  EXPECT_EQ(vtp.values<float>("texture_blend"), frame.texture_blend);
  for (const char* other : {"Normals", "color", "velocity", "rest_position", "id", "Points", "connectivity", "offsets"})
    vtp.values<std::uint8_t>(other);
  EXPECT_TRUE(vtp.is_all_covered());
}

TEST_F(VtpWriterTest, ParticleArraysAreWhereTheHeaderSays) {
  for (const int count : {0, 1, 33}) {
    const ParticleFrame frame = particle_frame(count);
    write_particles_vtp(path("p.vtp"), frame);
    const Vtp vtp(read_text(path("p.vtp")));
    EXPECT_EQ(vtp.attribute("Piece", "NumberOfPoints"), std::to_string(count));
    EXPECT_EQ(vtp.attribute("Piece", "NumberOfVerts"), std::to_string(count));
    EXPECT_EQ(vtp.attribute("Piece", "NumberOfPolys"), "0");
    expect_equal(vtp.values<float>("Points"), frame.state.positions, 3);
    expect_equal(vtp.values<float>("velocity"), frame.state.velocities, 3);
    expect_equal(vtp.values<float>("rest_position"), frame.state.rest_positions, 3);
    const std::vector<float> densities = vtp.values<float>("density");
    ASSERT_EQ(densities.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) EXPECT_EQ(densities[i], static_cast<float>(frame.state.densities[i]));
    EXPECT_EQ(vtp.values<std::uint64_t>("id"), frame.state.ids);
    EXPECT_EQ(vtp.values<std::uint8_t>("color").size(), 3 * frame.colors.size());
    const std::vector<std::int32_t> points = vtp.values<std::int32_t>("connectivity");
    const std::vector<std::int32_t> offsets = vtp.values<std::int32_t>("offsets");
    ASSERT_EQ(points.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) EXPECT_EQ(points[i], i);
    for (int i = 0; i < count; ++i) EXPECT_EQ(offsets[i], i + 1);
    EXPECT_TRUE(vtp.is_all_covered());
  }
}

TEST_F(VtpWriterTest, CollectionNamesTimesAndFiles) {
  write_pvd(path("a.pvd"), {{0, "surface/frame_0000.vtp"}, {1.0 / 30, "a&b<\".vtp"}});
  EXPECT_EQ(read_text(path("a.pvd")),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"surface/frame_0000.vtp\"/>\n"
            "    <DataSet timestep=\"0.03333333333333333\" group=\"\" part=\"0\" file=\"a&amp;b&lt;&quot;.vtp\"/>\n"
            "  </Collection>\n</VTKFile>\n");
}

}  // namespace
}  // namespace flowskin::scenes::vtp_writer_test
