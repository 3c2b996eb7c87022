// What is drawn in front of the walls: the surface or the particles of one frame.
#pragma once

#include <string>
#include <vector>

#include "tools/frame_data.h"
#include "tools/render/mip_map.h"
#include "tools/render/trace_scene.h"

namespace flowskin::tools {

/// What a surface frame's colour shows.
enum class Style {
  textured,    ///< The texture, by corner_uvs; by texture_blend faded to corner_uvs2, or to frame.colors.
  solid,       ///< frame.colors, smoothly between the vertices.
  normals,     ///< Red, green, blue = (1 + normal) / 2, sRGB-coded, neither lit nor developed: to be read off.
  confidence,  ///< frame.confidence of the weaker direction: dark blue 0, green, yellow 1.
};

/// @throws InputError naming the styles there are.
Style style_from_name(const std::string& name);

/// How a point reflects light.
struct Material {
  Vec3f reflectance{0, 0, 0};  ///< Linear
  Vec3f normal{0, 0, 1};       ///< Shading normal, unit.
  Vec3f lift{0, 0, 0};         ///< From the point to the smooth surface it stands for: shadow rays start there.
  bool unlit = false;          ///< `reflectance` is the final colour.
};

/// A frame ready to be traced.
class Subject {
 public:
  virtual ~Subject() = default;
  /// The material where a ray has hit; `footprint` is the area (m^2) that the sample covers there.
  virtual Material material(const RayHit& hit, const Vec3f& point, float footprint) const = 0;
  const TraceScene& scene() const { return scene_; }

 protected:
  explicit Subject(const TraceDevice& device) : scene_(device) {}
  TraceScene scene_;
};

/// Triangles with smooth normals. Keeps a reference to `frame` and `texture`.
class SurfaceSubject final : public Subject {
 public:
  /// `origin` is subtracted from all positions.
  /// @throws InputError where an array of the frame has the wrong length, a corner names no vertex, or a number is not
  /// finite.
  SurfaceSubject(const TraceDevice& device, const SurfaceFrame& frame, Style style, const MipMap& texture,
                 const Vec3& origin);
  Material material(const RayHit& hit, const Vec3f& point, float footprint) const override;

 private:
  Vec3f styled_color(const RayHit& hit, const Vec3f& normal, float footprint) const;
  Vec3f textured_color(const RayHit& hit, float footprint) const;
  Vec3f image_color(const RayHit& hit, const std::array<Vec2f, 3>& uvs, float footprint) const;
  Vec3f solid_color(const RayHit& hit) const;

  const SurfaceFrame& frame_;
  const MipMap& texture_;
  Style style_;
  std::vector<Vec3f> positions_, normals_;
};

/// Balls. Keeps a reference to `frame`.
class ParticleSubject final : public Subject {
 public:
  /// @throws InputError as SurfaceSubject, and where the radius is not positive.
  ParticleSubject(const TraceDevice& device, const ParticleFrame& frame, const Vec3& origin);
  Material material(const RayHit& hit, const Vec3f& point, float footprint) const override;

 private:
  const ParticleFrame& frame_;
};

}  // namespace flowskin::tools
