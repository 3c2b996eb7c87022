#include "scenes/io/frame_checks.h"

#include <cmath>
#include <string>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

/// Checks the arrays of one frame; `item` is "vertex" or "particle".
class FrameChecker {
 public:
  FrameChecker(const std::filesystem::path& file, const char* item, std::size_t count)
      : file_(file), item_(item), count_(count) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw RunError("cannot write " + file_.string() + ": " + message);
  }

  template <class T>
  void length(const std::vector<T>& values, const char* what) const {
    if (values.size() != count_)
      fail("there are " + std::to_string(count_) + " positions but " + std::to_string(values.size()) + " " + what);
  }

  /// Numbers beyond the range of float would become infinite in the file.
  template <class Vector>
  void finite(const std::vector<Vector>& values, const char* what) const {
    length(values, what);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!values[i].template cast<float>().allFinite())
        fail("the " + std::string(what) + " of " + item_ + " " + std::to_string(i) + " are not finite numbers");
  }

 private:
  const std::filesystem::path& file_;
  const char* item_;
  std::size_t count_;
};

void check_corners(const std::vector<std::array<Vec2f, 3>>& uvs, std::size_t triangle_count, const std::string& what,
                   const FrameChecker& checker) {
  if (uvs.size() != triangle_count)
    checker.fail("there are " + std::to_string(triangle_count) + " triangles but " + what + " for " +
                 std::to_string(uvs.size()));
  for (std::size_t i = 0; i < uvs.size(); ++i)
    for (const Vec2f& uv : uvs[i])
      if (!uv.allFinite())
        checker.fail("the " + what + " of triangle " + std::to_string(i) + " are not finite numbers");
}

/// What fades one texture into another: all of it, or only the weights, or nothing.
void check_blend(const SurfaceFrame& frame, const FrameChecker& checker) {
  if (!frame.texture_blend.empty()) checker.length(frame.texture_blend, "texture blend weights");
  for (const float weight : frame.texture_blend)
    if (!(weight >= 0 && weight <= 1)) checker.fail("a texture blend weight is not between 0 and 1");
  if (frame.corner_uvs2.empty() && frame.vertex_uvs2.empty()) return;
  if (frame.texture_blend.empty()) checker.length(frame.texture_blend, "texture blend weights");
  checker.finite(frame.vertex_uvs2, "second texture coordinates");
  check_corners(frame.corner_uvs2, frame.mesh.triangles.size(), "second texture coordinates", checker);
}

}  // namespace

void check_frame(const SurfaceFrame& frame, const std::filesystem::path& file) {
  const tracking::SurfaceMesh& mesh = frame.mesh;
  const FrameChecker checker(file, "vertex", mesh.positions.size());
  checker.finite(mesh.positions, "positions");
  checker.finite(mesh.rest_positions, "rest positions");
  checker.finite(mesh.velocities, "velocities");
  checker.finite(frame.normals, "normals");
  checker.finite(frame.vertex_uvs, "texture coordinates");
  if (!frame.confidence.empty()) checker.finite(frame.confidence, "confidences");
  check_blend(frame, checker);
  checker.length(mesh.ids, "ids");
  checker.length(frame.colors, "colours");
  check_corners(frame.corner_uvs, mesh.triangles.size(), "texture coordinates", checker);
  const auto vertex_count = static_cast<int>(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int vertex : mesh.triangles[i])
      if (vertex < 0 || vertex >= vertex_count)
        checker.fail("triangle " + std::to_string(i) + " refers to vertex " + std::to_string(vertex) + " of " +
                     std::to_string(vertex_count));
}

void check_frame(const ParticleFrame& frame, const std::filesystem::path& file) {
  const ParticleState& state = frame.state;
  const FrameChecker checker(file, "particle", state.positions.size());
  checker.finite(state.positions, "positions");
  checker.finite(state.velocities, "velocities");
  checker.finite(state.rest_positions, "rest positions");
  checker.length(state.densities, "densities");
  checker.length(state.ids, "ids");
  checker.length(frame.colors, "colours");
  for (std::size_t i = 0; i < state.densities.size(); ++i)
    if (!std::isfinite(static_cast<float>(state.densities[i])))
      checker.fail("the density of particle " + std::to_string(i) + " is not a finite number");
}

}  // namespace flowskin::scenes
