// The light of the pictures: a sun of some size, a sky, and the ground that reflects both.
#pragma once

#include <numbers>

#include "scenes/scene.h"
#include "tools/frame_data.h"

namespace flowskin::tools {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// Light arriving from all sides. Radiances are in units in which a white surface in full light has about 1.
struct Lighting {
  Vec3f sun_direction{0, 1, 0};   ///< Unit, towards the sun.
  float sun_radius = 0.1f;        ///< Half its angular diameter (radians).
  Vec3f sun_irradiance{0, 0, 0};  ///< On a surface that faces it.
  Vec3f horizon{0, 0, 0};         ///< Radiance of the sky at the horizon ...
  Vec3f zenith{0, 0, 0};          ///< ... and overhead.
  Vec3f below{0, 0, 0};           ///< Radiance from straight below where no ground is drawn.
  Vec3f softbox{0, 0, 0};         ///< Added radiance of a large soft light, which gives a glossy fluid its sheen.
  Vec3f softbox_direction{0, 1, 0};

  /// Radiance of the sky from a unit direction, without the sun.
  Vec3f sky(const Vec3f& direction) const;
  /// The same without the softbox: what the camera sees behind everything.
  Vec3f backdrop(const Vec3f& direction) const;
  /// Irradiance on an unshadowed surface with the given unit normal (the sky's part is an estimate): used for light
  /// that has been reflected once.
  Vec3f open_irradiance(const Vec3f& normal) const;
};

/// @throws InputError where the light has no direction or an impossible size.
Lighting make_lighting(const scenes::RenderSpec& settings);

/// A horizontal plane that fades into the backdrop far from the middle of the scene, so that no horizon shows.
struct Ground {
  bool visible = false;
  float height = 0;
  Vec3f reflectance{0, 0, 0};
  Vec3f center{0, 0, 0};
  float fade_start = 1, fade_end = 2;  ///< Distances from the centre.

  /// Distance along the ray at which it meets the plane from above, or infinity.
  float intersect(const Vec3f& origin, const Vec3f& direction) const;
  /// 0 near the scene, 1 where only the backdrop is left.
  float fade(const Vec3f& point) const;
};

/// Radiance of an environment of sky and ground, seen from `origin` and blocked by nothing.
Vec3f environment(const Lighting& lighting, const Ground& ground, const Vec3f& origin, const Vec3f& direction);

}  // namespace flowskin::tools
