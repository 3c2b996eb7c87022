#include "tools/io/frame_checks.h"

#include <cmath>
#include <string>

#include "tools/errors.h"

namespace flowskin::tools {
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
  checker.length(mesh.ids, "ids");
  checker.length(frame.colors, "colours");
  if (frame.corner_uvs.size() != mesh.triangles.size())
    checker.fail("there are " + std::to_string(mesh.triangles.size()) + " triangles but texture coordinates for " +
                 std::to_string(frame.corner_uvs.size()));
  const auto vertex_count = static_cast<int>(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles[i][k] < 0 || mesh.triangles[i][k] >= vertex_count)
        checker.fail("triangle " + std::to_string(i) + " refers to vertex " + std::to_string(mesh.triangles[i][k]) +
                     " of " + std::to_string(vertex_count));
      if (!frame.corner_uvs[i][k].allFinite())
        checker.fail("the texture coordinates of triangle " + std::to_string(i) + " are not finite numbers");
    }
}

void check_frame(const ParticleFrame& frame, const std::filesystem::path& file) {
  const scenes::ParticleState& state = frame.state;
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

}  // namespace flowskin::tools
