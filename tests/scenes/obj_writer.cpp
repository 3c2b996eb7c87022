#include <tiny_obj_loader.h>

#include <charconv>
#include <set>

#include "common/errors.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/obj_reader.h"
#include "tests/scenes/io_fixture.h"

namespace flowskin::scenes::obj_writer_test {
namespace {

class ObjWriterTest : public IoTest {
 protected:
  /// Writes the frame with its MTL and reads it with tinyobjloader.
  void round_trip(const SurfaceFrame& frame) {
    write_material(path("surface.mtl"), "checker.png");
    write_surface_obj(path("a.obj"), frame, "surface.mtl");
    reader_ = tinyobj::ObjReader();  // materials would pile up in the old one
    ASSERT_TRUE(reader_.ParseFromFile(path("a.obj").string())) << reader_.Error();
    EXPECT_EQ(reader_.Warning(), "");
  }
  tinyobj::ObjReader reader_;
};

void expect_near_float(double read, double written) { EXPECT_NEAR(read, written, 1.3e-7 * std::abs(written) + 1e-40); }

TEST_F(ObjWriterTest, TinyobjloaderReadsTheSame) {
  for (const Charts charts : {Charts::one, Charts::six}) {
    const SurfaceFrame frame = sphere_frame(3, charts);
    round_trip(frame);
    const tinyobj::attrib_t& attributes = reader_.GetAttrib();
    ASSERT_EQ(attributes.vertices.size(), 3 * frame.mesh.positions.size());
    ASSERT_EQ(attributes.normals.size(), 3 * frame.normals.size());
    for (std::size_t i = 0; i < frame.mesh.positions.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        expect_near_float(attributes.vertices[3 * i + k], frame.mesh.positions[i][k]);
        expect_near_float(attributes.normals[3 * i + k], frame.normals[i][k]);
      }
    ASSERT_EQ(reader_.GetShapes().size(), 1U);
    const tinyobj::mesh_t& mesh = reader_.GetShapes()[0].mesh;
    ASSERT_EQ(mesh.indices.size(), 3 * frame.mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const tinyobj::index_t index = mesh.indices[i];
      EXPECT_EQ(index.vertex_index, frame.mesh.triangles[i / 3][i % 3]);
      EXPECT_EQ(index.normal_index, index.vertex_index);
      const Vec2f& uv = frame.corner_uvs[i / 3][i % 3];
      expect_near_float(attributes.texcoords[2 * index.texcoord_index], uv.x());
      expect_near_float(attributes.texcoords[2 * index.texcoord_index + 1], uv.y());
    }
    ASSERT_EQ(reader_.GetMaterials().size(), 1U);
    EXPECT_EQ(reader_.GetMaterials()[0].diffuse_texname, "checker.png");
    EXPECT_EQ(mesh.material_ids[0], 0);
  }
}

TEST_F(ObjWriterTest, EveryVertexIsReferenced) {
  round_trip(sphere_frame());
  std::set<int> used;
  for (const tinyobj::index_t& index : reader_.GetShapes()[0].mesh.indices) used.insert(index.vertex_index);
  EXPECT_EQ(used.size(), reader_.GetAttrib().vertices.size() / 3);
}

TEST_F(ObjWriterTest, SharesEqualTextureCoordinates) {
  // With one chart, every vertex has one pair; with the box's six charts, there are more, but far from three a
  // triangle.
  const SurfaceFrame planar = sphere_frame(3, Charts::one);
  round_trip(planar);
  EXPECT_EQ(reader_.GetAttrib().texcoords.size() / 2, planar.mesh.positions.size());
  const SurfaceFrame box = sphere_frame(3, Charts::six);
  round_trip(box);
  EXPECT_GT(reader_.GetAttrib().texcoords.size() / 2, box.mesh.positions.size());
  EXPECT_LT(reader_.GetAttrib().texcoords.size() / 2, 2 * box.mesh.positions.size());
}

TEST_F(ObjWriterTest, NumbersComeBackToTheLastBit) {
  SurfaceFrame frame = sphere_frame(1);
  frame.mesh.positions[0] = Vec3(1e-30, 16777217.0, 0.1);
  frame.mesh.positions[1] = Vec3(-3.4e38, -0.0, 1.0 / 3);
  write_surface_obj(path("a.obj"), frame, "a.mtl");
  std::istringstream lines(read_text(path("a.obj")));
  std::size_t vertex = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("v ")) continue;
    const char* at = line.data() + 1;
    for (int k = 0; k < 3; ++k) {
      float value = 0;
      const auto [end, error] = std::from_chars(at + 1, line.data() + line.size(), value);
      ASSERT_EQ(error, std::errc()) << line;
      EXPECT_EQ(value, static_cast<float>(frame.mesh.positions[vertex][k])) << line;
      at = end;
    }
    ++vertex;
  }
  EXPECT_EQ(vertex, frame.mesh.positions.size());
}

TEST_F(ObjWriterTest, OurReaderReadsItToo) {
  const SurfaceFrame frame = sphere_frame();
  write_surface_obj(path("a.obj"), frame, "a.mtl");
  EXPECT_EQ(read_obj(path("a.obj")).triangles, frame.mesh.triangles);
}

TEST_F(ObjWriterTest, RefusesBadFrames) {
  const SurfaceFrame good = sphere_frame(1);
  const auto message = [&](const SurfaceFrame& frame) {
    return message_of<RunError>([&] { write_surface_obj(path("a.obj"), frame, "a.mtl"); });
  };
  SurfaceFrame bad = good;
  bad.mesh.positions[3].y() = NAN;
  EXPECT_NE(message(bad).find("the positions of vertex 3 are not finite"), std::string::npos);
  bad = good;
  bad.mesh.velocities[2].x() = 1e300;  // infinite as float
  EXPECT_NE(message(bad).find("the velocities of vertex 2"), std::string::npos);
  bad = good;
  bad.mesh.triangles[4][1] = 1000;
  EXPECT_NE(message(bad).find("triangle 4 refers to vertex 1000"), std::string::npos);
  bad = good;
  bad.normals.pop_back();
  EXPECT_NE(message(bad).find("normals"), std::string::npos);
  bad = good;
  bad.corner_uvs[5][2].x() = INFINITY;
  EXPECT_NE(message(bad).find("texture coordinates of triangle 5"), std::string::npos);
  EXPECT_EQ(files_in_folder(), 0U);
}

TEST_F(ObjWriterTest, AnEmptySurfaceIsAFileWithoutVertices) {
  write_surface_obj(path("a.obj"), SurfaceFrame(), "a.mtl");
  EXPECT_EQ(read_text(path("a.obj")).find("\nv "), std::string::npos);
}

}  // namespace
}  // namespace flowskin::scenes::obj_writer_test
