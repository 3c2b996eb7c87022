#include "tools/render/subject.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/errors.h"
#include "tools/render/color.h"
#include "tools/textures/perceptual_color.h"

namespace flowskin::tools {
namespace {

void require_length(const char* what, std::size_t length, std::size_t expected, const char* of) {
  if (length == expected) return;
  throw InputError(fmt::format("a frame to draw has {} {} for {} {}", length, what, expected, of));
}

std::vector<Vec3f> moved_to(const std::vector<Vec3>& points, const Vec3& origin, const char* what) {
  std::vector<Vec3f> moved;
  moved.reserve(points.size());
  for (const Vec3& point : points) {
    moved.push_back((point - origin).cast<float>());
    if (!moved.back().allFinite()) {
      throw InputError(fmt::format("{} {} of a frame to draw is not a finite place", what, moved.size() - 1));
    }
  }
  return moved;
}

void check_surface(const SurfaceFrame& frame, Style style) {
  const std::size_t vertices = frame.mesh.positions.size(), triangles = frame.mesh.triangles.size();
  require_length("normals", frame.normals.size(), vertices, "vertices");
  if (style == Style::solid) require_length("colours", frame.colors.size(), vertices, "vertices");
  if (style == Style::confidence) {
    if (frame.confidence.empty() && vertices > 0)
      throw InputError("the style confidence needs the scene's key tracking.confidence to be true when it is run");
    require_length("confidences", frame.confidence.size(), vertices, "vertices");
  }
  if (style == Style::textured) {
    require_length("corner texture coordinates", frame.corner_uvs.size(), triangles, "triangles");
    if (!frame.texture_blend.empty()) {
      require_length("texture blend weights", frame.texture_blend.size(), vertices, "vertices");
      if (frame.corner_uvs2.empty()) require_length("colours", frame.colors.size(), vertices, "vertices");
    }
    if (!frame.corner_uvs2.empty())
      require_length("second corner texture coordinates", frame.corner_uvs2.size(), triangles, "triangles");
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    for (const int corner : frame.mesh.triangles[t]) {
      if (corner < 0 || std::size_t(corner) >= vertices) {
        throw InputError(fmt::format("triangle {} of a frame to draw names vertex {} of {}", t, corner, vertices));
      }
    }
  }
}

// Linear light whose sRGB code is the given value.
Vec3f decode(const Vec3f& srgb) {
  return {srgb_to_linear(srgb.x()), srgb_to_linear(srgb.y()), srgb_to_linear(srgb.z())};
}

// From dark blue over green to yellow, evenly in lightness.
Vec3f heat(float share) {
  const double s = std::clamp(double(share), 0.0, 1.0);
  return linear_from_oklch(0.28 + 0.62 * s, 0.11 + 0.05 * s, 0.78 - 0.48 * s).cast<float>();
}

}  // namespace

Style style_from_name(const std::string& name) {
  if (name == "textured") return Style::textured;
  if (name == "solid") return Style::solid;
  if (name == "normals") return Style::normals;
  if (name == "confidence") return Style::confidence;
  throw InputError(fmt::format("render.style is \"{}\": expected textured, solid, normals or confidence", name));
}

SurfaceSubject::SurfaceSubject(const TraceDevice& device, const SurfaceFrame& frame, Style style, const MipMap& texture,
                               const Vec3& origin)
    : Subject(device), frame_(frame), texture_(texture), style_(style) {
  check_surface(frame, style);
  positions_ = moved_to(frame.mesh.positions, origin, "vertex");
  normals_.reserve(frame.normals.size());
  for (const Vec3& normal : frame.normals) normals_.push_back(normal.cast<float>());
  scene_.add_triangles(positions_, frame.mesh.triangles);
  scene_.commit();
}

Vec3f SurfaceSubject::image_color(const RayHit& hit, const std::array<Vec2f, 3>& uvs, float footprint) const {
  const auto& triangle = frame_.mesh.triangles[hit.primitive];
  const Vec2f uv = (1 - hit.u - hit.v) * uvs[0] + hit.u * uvs[1] + hit.v * uvs[2];
  const Vec2f e1 = uvs[1] - uvs[0], e2 = uvs[2] - uvs[0];
  const Vec3f& a = positions_[std::size_t(triangle[0])];
  const float area = (positions_[std::size_t(triangle[1])] - a).cross(positions_[std::size_t(triangle[2])] - a).norm();
  const float texture_area = std::abs(e1.x() * e2.y() - e1.y() * e2.x());
  const float density = area > 0 ? texture_area / area : 0;  // squares of the texture per m^2
  return texture_.sample(uv, footprint * density * texture_.texels());
}

Vec3f SurfaceSubject::solid_color(const RayHit& hit) const {
  const auto& triangle = frame_.mesh.triangles[hit.primitive];
  return (1 - hit.u - hit.v) * to_linear(frame_.colors[std::size_t(triangle[0])]) +
         hit.u * to_linear(frame_.colors[std::size_t(triangle[1])]) +
         hit.v * to_linear(frame_.colors[std::size_t(triangle[2])]);
}

Vec3f SurfaceSubject::textured_color(const RayHit& hit, float footprint) const {
  const Vec3f image = image_color(hit, frame_.corner_uvs[hit.primitive], footprint);
  if (frame_.texture_blend.empty()) return image;
  const auto& triangle = frame_.mesh.triangles[hit.primitive];
  const float share = (1 - hit.u - hit.v) * frame_.texture_blend[std::size_t(triangle[0])] +
                      hit.u * frame_.texture_blend[std::size_t(triangle[1])] +
                      hit.v * frame_.texture_blend[std::size_t(triangle[2])];
  if (share <= 0) return image;
  const Vec3f other =
      frame_.corner_uvs2.empty() ? solid_color(hit) : image_color(hit, frame_.corner_uvs2[hit.primitive], footprint);
  return (1 - share) * image + share * other;
}

Vec3f SurfaceSubject::styled_color(const RayHit& hit, const Vec3f& normal, float footprint) const {
  const auto& triangle = frame_.mesh.triangles[hit.primitive];
  const float w = 1 - hit.u - hit.v;
  switch (style_) {
    case Style::textured:
      return textured_color(hit, footprint);
    case Style::solid:
      return solid_color(hit);
    case Style::confidence:
      return heat(w * frame_.confidence[std::size_t(triangle[0])].x() +
                  hit.u * frame_.confidence[std::size_t(triangle[1])].x() +
                  hit.v * frame_.confidence[std::size_t(triangle[2])].x());
    case Style::normals:
      return decode(0.5f * (Vec3f::Ones() + normal));
  }
  return Vec3f::Constant(0.5f);
}

Material SurfaceSubject::material(const RayHit& hit, const Vec3f& point, float footprint) const {
  const auto& triangle = frame_.mesh.triangles[hit.primitive];
  const std::array<float, 3> weights{1 - hit.u - hit.v, hit.u, hit.v};
  Material material;
  Vec3f smooth = Vec3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3f& normal = normals_[std::size_t(triangle[k])];
    smooth += weights[k] * normal;
    // Against shadows of the single flat triangles on the smooth surface: the point is moved to where the tangent
    // planes of the corners meet, weighted (J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021).
    const float below = (point - positions_[std::size_t(triangle[k])]).dot(normal);
    if (below < 0) material.lift -= weights[k] * below * normal;
  }
  const float length = smooth.norm();
  material.normal = length > 1e-6f ? Vec3f(smooth / length) : hit.normal;
  if (!material.normal.allFinite()) material.normal = hit.normal;
  if (!material.lift.allFinite()) material.lift.setZero();
  material.reflectance = styled_color(hit, material.normal, footprint);
  material.unlit = style_ == Style::normals;
  return material;
}

ParticleSubject::ParticleSubject(const TraceDevice& device, const ParticleFrame& frame, const Vec3& origin)
    : Subject(device), frame_(frame) {
  const auto& positions = frame.state.positions;
  require_length("colours", frame.colors.size(), positions.size(), "particles");
  if (!positions.empty() && !(frame.radius > 0 && std::isfinite(frame.radius))) {
    throw InputError(fmt::format("particles to draw have the radius {}: expected a positive one", frame.radius));
  }
  scene_.add_balls(moved_to(positions, origin, "particle"), float(frame.radius));
  scene_.commit();
}

Material ParticleSubject::material(const RayHit& hit, const Vec3f&, float) const {
  Material material;
  material.normal = hit.normal;
  material.reflectance = to_linear(frame_.colors[hit.primitive]);
  return material;
}

}  // namespace flowskin::tools
