#include "scenes/io/obj_reader.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "common/errors.h"
#include "scenes/io/polygon.h"

namespace flowskin::scenes::obj_reader_test {
namespace {

sph::TriangleMesh read(const std::string& text) { return parse_obj(text, "a.obj"); }

std::string error(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("a.obj"), 0U) << "the file is not named";
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

double area(const sph::TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm() / 2;
  return sum;
}

double volume(const sph::TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6;
  return sum;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string unit_cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(ObjReader, ReadsTrianglesQuadsAndAllKindsOfIndices) {
  EXPECT_EQ(read(square + "f 1 2 3\n").triangles.size(), 1U);
  EXPECT_EQ(read(square + "f 1/1 2/1 3/1 4/1\n").triangles.size(), 2U);
  EXPECT_EQ(read(square + "f 1//7 2//7 3//7\n").triangles[0], (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(read(square + "f -4 -3 -2\n").triangles[0], (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(read("# comment\r\nmtllib no_such.mtl\r\no a\r\nv 0 0 0\r\nv 1 0 0\r\n  v\t0 1 0 1.0\r\nvn 0 0 1\r\nvt 0 "
                 "0\r\ns off\r\n"
                 "usemtl m\r\nl 1 2\r\nf 1 2 3")
                .triangles.size(),
            1U);
  EXPECT_EQ(read("f 1 2 3\n" + square).triangles.size(), 1U) << "faces may stand before their vertices";
  EXPECT_EQ(read("v +1 .5 -2.\nv 1e1 0 0\nv 0 1 0\nf 1 2 3\n").positions[0], Vec3(1, 0.5, -2));
}

TEST(ObjReader, KeepsAClosedCubeClosedAndOutward) {
  const sph::TriangleMesh cube = read(unit_cube);
  EXPECT_EQ(cube.triangles.size(), 12U);
  EXPECT_NEAR(volume(cube), 1, 1e-12);
  EXPECT_NEAR(area(cube), 6, 1e-12);
}

TEST(ObjReader, DropsUnreferencedVerticesAndTrianglesWithoutThreeCorners) {
  const sph::TriangleMesh mesh = read("v 9 9 9\nv 0 0 0\nv 8 8 8\nv 1 0 0\nv 0 1 0\nf 2 4 5\nf 2 2 5\n");
  ASSERT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
}

TEST(ObjReader, CutsConcavePolygonsCorrectly) {
  // The side of a flight of stairs with four steps: a fan from its first corner would leave the polygon.
  std::string text = "v 0 0 0\n";
  std::string face = "f 1";
  for (int k = 0; k < 4; ++k) {
    text += "v " + std::to_string(4 - k) + " " + std::to_string(k) + " 0\nv " + std::to_string(4 - k) + " " +
            std::to_string(k + 1) + " 0\n";
    face += " " + std::to_string(2 * k + 2) + " " + std::to_string(2 * k + 3);
  }
  text += "v 0 4 0\n";
  const sph::TriangleMesh stairs = read(text + face + " 10\n");
  EXPECT_NEAR(area(stairs), 4 + 3 + 2 + 1, 1e-12) << "overlapping triangles make the area larger";
  for (const auto& [a, b, c] : stairs.triangles)
    EXPECT_GE((stairs.positions[b] - stairs.positions[a]).cross(stairs.positions[c] - stairs.positions[a]).z(), 0);
}

TEST(ObjReader, ReadsPolygonsBeyond255Corners) {
  std::string text, face = "f";
  for (int k = 0; k < 1000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 1000, radius = k % 2 == 0 ? 1 : 0.9;
    text += "v " + std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) + " 0\n";
    face += " " + std::to_string(k + 1);
  }
  const sph::TriangleMesh star = read(text + face + "\n");
  EXPECT_EQ(star.triangles.size(), 998U);
  EXPECT_NEAR(area(star), 500 * 0.9 * std::sin(2 * std::numbers::pi / 1000), 1e-4);
}

TEST(ObjReader, SaysWhatIsWrong) {
  EXPECT_NE(error("").find("no vertices"), std::string::npos);
  EXPECT_NE(error("this is a letter\nto somebody\n").find("no OBJ"), std::string::npos);
  EXPECT_NE(error(std::string("\x7f"
                              "ELF\0\0\0",
                              7))
                .find("binary"),
            std::string::npos);
  EXPECT_NE(error(square).find("no triangles"), std::string::npos);
  EXPECT_NE(error(square + "f 1 1 2\n").find("no triangles"), std::string::npos);
  EXPECT_NE(error("v 0 0 0\nv nan 0 0\nf 1 2 1\n").find("line 2: expected a finite number as x"), std::string::npos);
  EXPECT_NE(error("\r\nv 0 0 0\r\nv 0 inf 0\r\n").find("line 3: expected a finite number as y"), std::string::npos);
  EXPECT_NE(error("v 0 0\n").find("as z of a vertex, found \"\""), std::string::npos);
  EXPECT_NE(error("v 0,5 1 1\n").find("found \"0,5\""), std::string::npos);
  EXPECT_NE(error("v 0 1e999 1\n").find("found \"1e999\""), std::string::npos);
  EXPECT_NE(error(square + "f 1 2 3\nf 1 2 5\n").find("face 2 refers to vertex 5, but there are only 4"),
            std::string::npos);
  EXPECT_NE(error(square + "f 0 1 2\n").find("count from 1"), std::string::npos);
  EXPECT_NE(error(square + "f 1 2 -5\n").find("refers to vertex -5"), std::string::npos);
  EXPECT_NE(error(square + "f 1 two 3\n").find("line 5: expected a vertex index as corner of a face, found \"two\""),
            std::string::npos);
  EXPECT_NE(error(square + "f 1 2 99999999999999999999\n").find("found \"99999999999999999999\""), std::string::npos);
  std::string huge = square + "f";
  for (int k = 0; k < 5000; ++k) huge += " 1 2 3";
  EXPECT_NE(error(huge + "\n").find("15000 corners"), std::string::npos);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flowskin_obj_reader_test.obj";
  std::ofstream(file) << unit_cube;
  EXPECT_EQ(read_obj(file).triangles, read(unit_cube).triangles);
  std::filesystem::remove(file);
  EXPECT_THROW(read_obj("/no/such/file.obj"), InputError);
  EXPECT_THROW(read_obj(std::filesystem::temp_directory_path()), InputError);
}

TEST(ObjReader, SurvivesEveryTruncationAndEveryChangedByte) {
  const std::string text = unit_cube;
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char replacement : {'\0', '/', '9', '-', '\n', 'f', 'e'}) {
      std::string changed = text;
      changed[i] = replacement;
      try {
        read(changed);
      } catch (const InputError&) {
      }
    }
    try {
      read(text.substr(0, i));
    } catch (const InputError&) {
    }
  }
}

TEST(ObjReader, PlacingScalesThenRotatesThenTranslates) {
  MeshPlacement placement;
  placement.scale = Vec3(2, 1, 1);
  placement.rotate = Vec3(0, 0, 90);
  placement.translate = Vec3(10, 0, 0);
  const sph::TriangleMesh mesh = place(read(unit_cube), placement);
  EXPECT_TRUE(mesh.positions[1].isApprox(Vec3(10, 2, 0), 1e-12));
  EXPECT_NEAR(volume(mesh), 2, 1e-9);
  placement.rotate = Vec3(90, 90, 0);  // x first: y to z, z to -y; then y: z to x
  EXPECT_TRUE(place(read(unit_cube), placement).positions[3].isApprox(Vec3(11, 0, 0), 1e-12));
}

TEST(ObjReader, MirroringKeepsOutsideOutside) {
  MeshPlacement placement;
  placement.scale = Vec3(-1, 2, 3);
  EXPECT_NEAR(volume(place(read(unit_cube), placement)), 6, 1e-12);
  placement.scale = Vec3(-1, -2, 3);
  EXPECT_NEAR(volume(place(read(unit_cube), placement)), 6, 1e-12);
  placement.scale = Vec3(1, 0, 1);
  EXPECT_THROW(place(read(unit_cube), placement), InputError);
  placement.scale = Vec3(1, NAN, 1);
  EXPECT_THROW(place(read(unit_cube), placement), InputError);
  placement = MeshPlacement();
  EXPECT_EQ(place(read(unit_cube), placement).positions, read(unit_cube).positions) << "no placement changes no bit";
}

TEST(TriangulatePolygon, FinishesPolygonsThatCrossThemselves) {
  const std::vector<Vec3> bow_tie{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(triangulate_polygon(bow_tie, {0, 1, 2, 3}).size(), 2U);
  EXPECT_EQ(triangulate_polygon(std::vector<Vec3>(5, Vec3::Zero()), {0, 1, 2, 3, 4}).size(), 3U);
  EXPECT_TRUE(triangulate_polygon(bow_tie, {0, 1}).empty());
}

}  // namespace
}  // namespace flowskin::scenes::obj_reader_test
