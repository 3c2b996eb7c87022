#include <cstring>

#include "common/errors.h"
#include "scenes/io/byte_buffer.h"
#include "scenes/io/frame_attributes.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"
#include "tests/scenes/io_fixture.h"
#include "tracking/mesh/vertex_attributes.h"

namespace flowskin::scenes::ply_writer_test {
namespace {

class PlyWriterTest : public IoTest {};

/// Through memory: g++ 12 at -O3 drops the way to float and back where it vectorises over several components.
double as_float(double value) {
  volatile float rounded = static_cast<float>(value);
  return static_cast<double>(rounded);
}
Vec3 as_float(const Vec3& v) { return {as_float(v.x()), as_float(v.y()), as_float(v.z())}; }

TEST_F(PlyWriterTest, SurfaceComesBackAsFloats) {
  const SurfaceFrame frame = sphere_frame(3);
  write_surface_ply(path("a.ply"), frame);
  const tracking::SurfaceMesh mesh = read_surface_ply(path("a.ply"));
  ASSERT_EQ(mesh.positions.size(), frame.mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.positions[i], as_float(frame.mesh.positions[i]));
    EXPECT_EQ(mesh.rest_positions[i], as_float(frame.mesh.rest_positions[i]));
    EXPECT_EQ(mesh.velocities[i], as_float(frame.mesh.velocities[i]));
  }
  EXPECT_EQ(mesh.ids, frame.mesh.ids);
  EXPECT_EQ(mesh.triangles, frame.mesh.triangles);
  EXPECT_EQ(mesh.next_id, frame.mesh.ids.back() + 1);
}

TEST_F(PlyWriterTest, SurfaceHasAllProperties) {
  SurfaceFrame frame = sphere_frame(2);
  frame.texture_file = "checker.png";
  write_surface_ply(path("a.ply"), frame);
  const PlyFile ply = read_ply(path("a.ply"));
  EXPECT_EQ(ply.vertex.size(), 20U);
  EXPECT_EQ(ply.comments,
            (std::vector<std::string>{"FlowSkin surface, m, s, y up", "time 0.1", "TextureFile checker.png"}));
  for (std::size_t i = 0; i < ply.vertex_count; ++i) {
    EXPECT_EQ(ply.vertex.at("nx")[i], as_float(frame.normals[i].x()));
    EXPECT_EQ(ply.vertex.at("s")[i], frame.vertex_uvs[i].x());
    EXPECT_EQ(ply.vertex.at("texture_u")[i], frame.vertex_uvs[i].x());
    EXPECT_EQ(ply.vertex.at("t")[i], frame.vertex_uvs[i].y());
    EXPECT_EQ(ply.vertex.at("texture_v")[i], frame.vertex_uvs[i].y());
    EXPECT_EQ(ply.vertex.at("red")[i], frame.colors[i][0]);
    EXPECT_EQ(ply.vertex.at("blue")[i], frame.colors[i][2]);
  }
}

/// Whatever is in the table of attributes is in the file under its names, and what is the mesh's is read back.
TEST_F(PlyWriterTest, EveryAttributeOfTheTableComesBack) {
  SurfaceFrame frame = sphere_frame(2);
  frame.vertex_uvs2 = frame.vertex_uvs;
  frame.corner_uvs2 = frame.corner_uvs;
  for (const Vec2f& uv : frame.vertex_uvs) {
    frame.confidence.emplace_back(0.5F * uv.x(), 1);
    frame.texture_blend.push_back(1 / (1 + uv.squaredNorm()));
  }
  write_surface_ply(path("a.ply"), frame);
  const PlyFile ply = read_ply(path("a.ply"));
  std::size_t columns = 0;
  for_each_surface_attribute(frame, [&](const FileAttribute& attribute, const auto& values) {
    using T = typename std::remove_cvref_t<decltype(values)>::value_type;
    ASSERT_FALSE(values.empty()) << attribute.plural;
    columns += attribute.ply.size();
    for (std::size_t k = 0; k < attribute.ply.size(); ++k) {
      const std::vector<double>& column = ply.vertex.at(std::string(attribute.ply[k]));
      for (std::size_t i = 0; i < values.size(); ++i) {
        if constexpr (std::is_arithmetic_v<T>)
          EXPECT_EQ(column[i], as_float(static_cast<double>(values[i]))) << attribute.ply[k];
        else
          EXPECT_EQ(column[i], as_float(static_cast<double>(values[i][k % components_of<T>]))) << attribute.ply[k];
      }
    }
  });
  EXPECT_EQ(ply.vertex.size(), columns);
  SurfaceFrame again;
  again.mesh = read_surface_ply(path("a.ply"));
  tracking::for_each_attribute(again.mesh, [&](auto, std::string_view name, const auto& values) {
    EXPECT_EQ(values.size(), frame.mesh.positions.size()) << name << " is not in the table of attributes";
  });
}

/// The bytes are checked without our reader: the last face stands at the very end.
TEST_F(PlyWriterTest, FacesCarryTextureCoordinatesOfTheirCorners) {
  const SurfaceFrame frame = sphere_frame(1);
  write_surface_ply(path("a.ply"), frame);
  const std::string bytes = read_text(path("a.ply"));
  constexpr std::size_t face_size = 1 + 3 * 4 + 1 + 6 * 4;
  const std::size_t header = bytes.find("end_header\n") + 11;
  constexpr std::size_t vertex_size = 4 * (3 + 3 + 4) + 3 + 4 * (3 + 3) + 4;
  ASSERT_EQ(bytes.size(), header + vertex_size * frame.mesh.positions.size() + face_size * frame.mesh.triangles.size());
  const char* face = bytes.data() + bytes.size() - face_size;
  EXPECT_EQ(face[0], 3);
  EXPECT_EQ(face[13], 6);
  for (int k = 0; k < 3; ++k) {
    std::int32_t vertex = 0;
    std::array<float, 2> uv{};
    std::memcpy(&vertex, face + 1 + 4 * k, 4);
    std::memcpy(uv.data(), face + 14 + 8 * k, 8);
    EXPECT_EQ(vertex, frame.mesh.triangles.back()[k]);
    EXPECT_EQ(Vec2f(uv[0], uv[1]), frame.corner_uvs.back()[k]);
  }
}

TEST_F(PlyWriterTest, LargeIdsAreWrittenAsDouble) {
  SurfaceFrame frame = sphere_frame(0);
  frame.mesh.ids[2] = (std::uint64_t{1} << 40) + 3;
  write_surface_ply(path("a.ply"), frame);
  EXPECT_NE(read_text(path("a.ply")).find("property double id"), std::string::npos);
  EXPECT_EQ(read_surface_ply(path("a.ply")).ids, frame.mesh.ids);
  frame.mesh.ids[2] = (std::uint64_t{1} << 60);
  message_of<RunError>([&] { write_surface_ply(path("b.ply"), frame); });
}

TEST_F(PlyWriterTest, ParticlesComeBack) {
  const ParticleFrame frame = particle_frame(50);
  write_particles_ply(path("p.ply"), frame);
  const ParticleState state = particles_from_ply(path("p.ply"));
  EXPECT_EQ(state.ids, frame.state.ids);
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    EXPECT_EQ(state.positions[i], as_float(frame.state.positions[i]));
    EXPECT_EQ(state.velocities[i], as_float(frame.state.velocities[i]));
    EXPECT_EQ(state.rest_positions[i], as_float(frame.state.rest_positions[i]));
    EXPECT_EQ(state.densities[i], as_float(frame.state.densities[i]));
  }
  const PlyFile ply = read_ply(path("p.ply"));
  EXPECT_EQ(ply.vertex.at("green")[3], frame.colors[3][1]);
  write_particles_ply(path("none.ply"), particle_frame(0));
  EXPECT_TRUE(particles_from_ply(path("none.ply")).ids.empty());
}

TEST_F(PlyWriterTest, ForeignSurfacesAreRefusedWithTheReason) {
  const auto message = [&](const std::string& text) {
    const std::string file = write_text("a.ply", text);
    return message_of<InputError>([&] { read_surface_ply(file); });
  };
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_NE(message(header + "end_header\n0 0 0\n").find("\"rest_x\""), std::string::npos);
  EXPECT_NE(message(header + "end_header\n0 nan 0\n").find("\"y\" is not a finite number"), std::string::npos);
  EXPECT_NE(message("solid cube\n").find("no PLY"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_surface_ply(path("missing.ply")); }).find("no such file"),
            std::string::npos);
}

TEST_F(PlyWriterTest, EveryTruncationIsNoticed) {
  const SurfaceFrame frame = sphere_frame(0);
  write_surface_ply(path("a.ply"), frame);
  const std::string bytes = read_text(path("a.ply"));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(parse_ply(std::string_view(bytes).substr(0, size), "b.ply"), InputError) << size;
  }
}

}  // namespace
}  // namespace flowskin::scenes::ply_writer_test
