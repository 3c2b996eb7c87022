#include "scenes/io/frame_checks.h"

#include <cmath>
#include <string>
#include <string_view>

#include "common/errors.h"
#include "scenes/io/frame_attributes.h"

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
  void length(const std::vector<T>& values, std::string_view what) const {
    if (values.size() != count_)
      fail("there are " + std::to_string(count_) + " positions but " + std::to_string(values.size()) + " " +
           std::string(what));
  }

  /// Numbers beyond the range of float would become infinite in the file.
  template <class Vector>
  void finite(const std::vector<Vector>& values, std::string_view what) const {
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

/// The weights of a second texture, which must be there where its coordinates are.
void check_blend(const SurfaceFrame& frame, const FrameChecker& checker) {
  for (const float weight : frame.texture_blend)
    if (!(weight >= 0 && weight <= 1)) checker.fail("a texture blend weight is not between 0 and 1");
  if (frame.corner_uvs2.empty() && frame.vertex_uvs2.empty()) return;
  checker.length(frame.texture_blend, "texture blend weights");
  checker.length(frame.vertex_uvs2, "second texture coordinates");
  check_corners(frame.corner_uvs2, frame.mesh.triangles.size(), "second texture coordinates", checker);
}

/// Every array has one value an item, and those of vectors are finite.
template <class Frame>
void check_attributes(const Frame& frame, const FrameChecker& checker) {
  for_each_file_attribute(frame, [&](const FileAttribute& attribute, const auto& values) {
    if (attribute.optional && values.empty()) return;
    if constexpr (requires { values[0].allFinite(); })
      checker.finite(values, attribute.plural);
    else
      checker.length(values, attribute.plural);
  });
}

}  // namespace

void check_frame(const SurfaceFrame& frame, const std::filesystem::path& file) {
  const tracking::SurfaceMesh& mesh = frame.mesh;
  const FrameChecker checker(file, "vertex", mesh.positions.size());
  check_attributes(frame, checker);
  check_blend(frame, checker);
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
  check_attributes(frame, checker);
  for (std::size_t i = 0; i < state.densities.size(); ++i)
    if (!std::isfinite(static_cast<float>(state.densities[i])))
      checker.fail("the density of particle " + std::to_string(i) + " is not a finite number");
}

}  // namespace flowskin::scenes
