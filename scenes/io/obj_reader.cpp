#include "scenes/io/obj_reader.h"

#include <tiny_obj_loader.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string_view>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/polygon.h"
#include "scenes/io/read_bytes.h"

namespace flowskin::scenes {
namespace {

/// Clipping ears takes quadratic time at least; nothing drawn by hand comes near this.
constexpr int largest_polygon = 4096;

/// Faces as they come in; a mistake is kept in `error`, since exceptions must not pass through tinyobjloader.
struct ObjFaces {
  std::vector<Vec3> positions;
  std::vector<std::vector<int>> faces;
  std::string error;
};

void add_vertex(void* user, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t z, tinyobj::real_t) {
  static_cast<ObjFaces*>(user)->positions.emplace_back(x, y, z);
}

/// Indices count from 1; negative ones count back from the vertices read so far.
void add_face(void* user, tinyobj::index_t* indices, int count) {
  ObjFaces& obj = *static_cast<ObjFaces*>(user);
  if (!obj.error.empty()) return;
  const std::string face = "face " + std::to_string(obj.faces.size() + 1);
  if (count > largest_polygon)
    obj.error = face + " has " + std::to_string(count) + " corners, more than the " + std::to_string(largest_polygon) +
                " allowed: cut it into triangles in the program that made the file";
  std::vector<int> corners;
  for (int k = 0; k < count && obj.error.empty(); ++k) {
    const int index = indices[k].vertex_index;
    const auto read_so_far = static_cast<int>(obj.positions.size());
    corners.push_back(index > 0 ? index - 1 : read_so_far + index);
    // Indices of vertices that come later in the file are legal; they are checked at the end.
    if (index == 0 || corners.back() < 0)
      obj.error = face + " refers to vertex " + std::to_string(index) +
                  (index == 0 ? ", but vertices count from 1" : ", but fewer come before it");
  }
  obj.faces.push_back(std::move(corners));
}

void check_vertex_line(std::string_view line, const std::string& place) {
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string_view word = take_word(line);
    std::string_view rest = word;
    double value = 0;
    if (!take_number(rest, value) || !rest.empty() || !std::isfinite(value))
      throw InputError(place + ": expected a finite number as " + axis + " of a vertex, found \"" +
                       std::string(word.substr(0, 40)) + "\"");
  }
}

void check_face_line(std::string_view line, const std::string& place) {
  for (std::string_view word = take_word(line); !word.empty() && word[0] != '#'; word = take_word(line)) {
    const std::string_view vertex = word.substr(0, word.find('/'));
    int index = 0;
    const auto [end, error] = std::from_chars(vertex.data(), vertex.data() + vertex.size(), index);
    if (error != std::errc() || end != vertex.data() + vertex.size())
      throw InputError(place + ": expected a vertex index as corner of a face, found \"" +
                       std::string(word.substr(0, 40)) + "\"");
  }
}

/// A \ at the end of a line: it goes on in the next one.
std::string with_joined_lines(std::string text) {
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    const std::size_t end = text.find_first_not_of(" \t\r", at + 1);
    if (end != std::string::npos && text[end] == '\n') std::fill(text.begin() + at, text.begin() + end + 1, ' ');
  }
  return text;
}

/// tinyobjloader takes what is no number for 0, and an index beyond int for anything: so lines are checked before.
void check_lines(std::string_view text, const std::string& name) {
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    const bool two_characters = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(text.size(), end + (two_characters ? 2 : 1)));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") check_vertex_line(line, name + ", line " + std::to_string(line_number));
    if (keyword == "f") check_face_line(line, name + ", line " + std::to_string(line_number));
  }
}

/// Vertices that no triangle uses are dropped; the others keep their order.
sph::TriangleMesh keep_referenced(const std::vector<Vec3>& positions, std::vector<std::array<int, 3>> triangles) {
  std::vector<int> place(positions.size(), -1);
  for (const auto& triangle : triangles)
    for (const int vertex : triangle) place[vertex] = 0;
  sph::TriangleMesh mesh;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<int>(mesh.positions.size());
    mesh.positions.push_back(positions[i]);
  }
  for (auto& triangle : triangles)
    for (int& vertex : triangle) vertex = place[vertex];
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

sph::TriangleMesh read_obj(const std::filesystem::path& file) { return parse_obj(read_bytes(file), file.string()); }

sph::TriangleMesh parse_obj(const std::string& written, const std::string& name) {
  const std::string text = with_joined_lines(written);
  if (text.find('\0') != std::string::npos) throw InputError(name + ": this is a binary file, no OBJ");
  check_lines(text, name);

  tinyobj::callback_t callback;
  callback.vertex_cb = add_vertex;
  callback.index_cb = add_face;
  ObjFaces obj;
  std::istringstream stream(text);
  std::string warning, error;
  const bool good = tinyobj::LoadObjWithCallback(stream, callback, &obj, nullptr, &warning, &error);
  if (!obj.error.empty()) throw InputError(name + ": " + obj.error);
  if (!good) throw InputError(name + ": not readable as OBJ: " + error);
  if (obj.positions.empty())
    throw InputError(name + ": no vertices (lines \"v x y z\"): this is no OBJ, or it is empty");

  const auto vertex_count = static_cast<int>(obj.positions.size());
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 0; i < obj.faces.size(); ++i) {
    for (const int vertex : obj.faces[i])
      if (vertex >= vertex_count)
        throw InputError(name + ": face " + std::to_string(i + 1) + " refers to vertex " + std::to_string(vertex + 1) +
                         ", but there are only " + std::to_string(vertex_count));
    if (obj.faces[i].size() < 3) continue;  // a line or a point
    for (const auto& triangle : triangulate_polygon(obj.positions, obj.faces[i]))
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        triangles.push_back(triangle);
  }
  if (triangles.empty())
    throw InputError(name + ": no triangles (lines \"f a b c\"): a surface was expected, not points or curves");
  return keep_referenced(obj.positions, std::move(triangles));
}

sph::TriangleMesh place(sph::TriangleMesh mesh, const MeshPlacement& placement) {
  const std::string name = placement.file.empty() ? "mesh" : placement.file;
  const Vec3& scale = placement.scale;
  if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0)
    throw InputError(name + ": scale must be finite and not 0 in any direction");
  if (!placement.rotate.allFinite() || !placement.translate.allFinite())
    throw InputError(name + ": rotate and translate must be finite");
  const Vec3 angles = placement.rotate * (std::numbers::pi / 180);
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(angles.x(), Vec3::UnitX()))
          .toRotationMatrix();
  // The plain copy stays exact where nothing is turned: rotation by zero degrees is the identity to the last bit.
  for (Vec3& x : mesh.positions) x = rotation * scale.cwiseProduct(x) + placement.translate;
  if (scale.prod() < 0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

}  // namespace flowskin::scenes
