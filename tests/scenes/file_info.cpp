#include "scenes/io/file_info.h"

#include "common/errors.h"
#include "scenes/io/frame_files.h"
#include "tests/scenes/io_fixture.h"

namespace flowskin::scenes::file_info_test {
namespace {

class FileInfoTest : public IoTest {};

std::string joined(const FileInfo& info) {
  std::string text;
  for (const std::string& line : info.lines) text += line + "\n";
  return text;
}

TEST_F(FileInfoTest, SoundSurfaces) {
  const SurfaceFrame frame = sphere_frame(3);
  write_surface_obj(path("a.obj"), frame, "a.mtl");
  write_surface_ply(path("a.ply"), frame);
  for (const char* name : {"a.obj", "a.ply"}) {
    const FileInfo info = describe_file(path(name));
    EXPECT_TRUE(info.sound) << joined(info);
    for (const char* fact : {"258 vertices, 512 triangles", "parts: 1, Euler characteristic 2", "volume: 4.0",
                             "area: 12.", "bounds: x -0.9 to 1.1"})
      EXPECT_NE(joined(info).find(fact), std::string::npos) << fact << "\n" << joined(info);
  }
}

TEST_F(FileInfoTest, OpenAndInsideOutSurfacesAreUnsound) {
  SurfaceFrame frame = sphere_frame(1);
  frame.mesh.triangles.pop_back();
  frame.corner_uvs.pop_back();
  write_surface_ply(path("open.ply"), frame);
  EXPECT_FALSE(describe_file(path("open.ply")).sound);
  frame = sphere_frame(1);
  for (auto& triangle : frame.mesh.triangles) std::swap(triangle[0], triangle[1]);
  write_surface_obj(path("out.obj"), frame, "a.mtl");
  const FileInfo info = describe_file(path("out.obj"));
  EXPECT_FALSE(info.sound);
  EXPECT_NE(joined(info).find("not a sound closed surface"), std::string::npos);
}

// Two spheres through each other: closed, outward, but not a surface that bounds anything.
TEST_F(FileInfoTest, SelfIntersectionsAreUnsound) {
  const tracking::SurfaceMesh mesh = sphere_mesh(1);
  const tracking::SurfaceMesh second = sphere_mesh(1, Vec3(1, 0, 0));
  const int offset = static_cast<int>(mesh.positions.size());
  std::ostringstream obj;
  for (const auto* part : {&mesh, &second})
    for (const Vec3& x : part->positions) obj << "v " << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
  for (const auto& [a, b, c] : mesh.triangles) obj << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  for (const auto& [a, b, c] : second.triangles)
    obj << "f " << a + offset + 1 << ' ' << b + offset + 1 << ' ' << c + offset + 1 << '\n';
  const FileInfo info = describe_file(write_text("two.obj", obj.str()));
  EXPECT_FALSE(info.sound);
  EXPECT_NE(joined(info).find("pairs of triangles intersect, the first triangles "), std::string::npos) << joined(info);
  EXPECT_NE(joined(info).find(" near ("), std::string::npos) << joined(info);
  EXPECT_EQ(joined(info).find("open edges"), std::string::npos) << joined(info);
}

TEST_F(FileInfoTest, Particles) {
  write_particles_ply(path("p.ply"), particle_frame(10));
  const FileInfo info = describe_file(path("p.ply"));
  EXPECT_TRUE(info.sound);
  for (const char* fact : {"particles: 10", "speed: ", "density: 1000 to 1001.29 kg/m^3", "ids: 7 to 25", "rest_x"})
    EXPECT_NE(joined(info).find(fact), std::string::npos) << fact << "\n" << joined(info);
  write_particles_ply(path("none.ply"), particle_frame(0));
  EXPECT_NE(joined(describe_file(path("none.ply"))).find("particles: 0"), std::string::npos);
}

TEST_F(FileInfoTest, GoesByTheContent) {
  const SurfaceFrame frame = sphere_frame(2);
  write_surface_obj(path("a.obj"), frame, "a.mtl");
  write_surface_ply(path("a.ply"), frame);
  write_surface_vtp(path("a.vtp"), frame);
  for (const char* name : {"a.obj", "a.ply", "a.vtp"}) {
    std::filesystem::rename(path(name), path("some.thing"));
    const FileInfo info = describe_file(path("some.thing"));
    EXPECT_TRUE(info.sound) << name << "\n" << joined(info);
    EXPECT_NE(joined(info).find("66 vertices, 128 triangles"), std::string::npos) << name << "\n" << joined(info);
  }
  const std::filesystem::path data = std::filesystem::path(FLOWSKIN_SOURCE_DIR) / "tests/scenes/data/anyone";
  EXPECT_NE(joined(describe_file(data / "plain.dump")).find("time steps: 3, numbered 0 to 200"), std::string::npos);
  EXPECT_NE(joined(describe_file(data / "steps.h5part")).find("time steps: 3, 0 to 0.5 s"), std::string::npos);
  const std::string parts = joined(describe_sequence(data / "parts.pvd"));
  EXPECT_NE(parts.find("sequence: 4 files for 3 times"), std::string::npos) << parts;
  EXPECT_NE(parts.find("particles: 8 (VTK"), std::string::npos) << parts;
  std::filesystem::copy(data / "series.vtk.series", path("series"));
  std::filesystem::copy(data / "step_0.vtp", path("step_0.vtp"));
  const FileInfo broken = describe_sequence(path("series"));
  EXPECT_FALSE(broken.sound);
  EXPECT_NE(joined(broken).find("missing: " + path("step_2.vtp").string()), std::string::npos) << joined(broken);
}

TEST_F(FileInfoTest, FoldersNamedByTimeAreToldByTheirNames) {
  for (const char* time : {"0", "0.1", "0.2"}) {
    std::filesystem::create_directories(path(time));
    write_text(std::string(time) + "/p.csv", "x,y,z\n0,0,0\n");
  }
  const std::string text = joined(describe_sequence(path("")));
  EXPECT_NE(text.find("sequence: 3 files, 0/p.csv to 0.2/p.csv"), std::string::npos) << text;
  std::filesystem::create_directories(path("0.10"));
  write_text("0.10/p.csv", "x,y,z\n0,0,0\n");
  EXPECT_NE(message_of<InputError>([&] { describe_sequence(path("")); }).find("list the files that count"),
            std::string::npos);
}

TEST_F(FileInfoTest, SaysWhatCannotBeRead) {
  EXPECT_NE(message_of<InputError>([&] { describe_file(write_text("a.stl", "solid")); }).find("columns x, y and z"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { describe_file(path("a.obj")); }).find("no such file"), std::string::npos);
  const std::string twice = write_text("t.ply",
                                       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                       "property float z\nproperty int id\nend_header\n0 0 0 4\n1 1 1 4\n");
  EXPECT_NE(message_of<InputError>([&] { describe_file(twice); }).find("two particles have the id 4"),
            std::string::npos);
}

}  // namespace
}  // namespace flowskin::scenes::file_info_test
