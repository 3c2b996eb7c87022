#include "tools/render/lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.h"

namespace flowskin::tools {
namespace {

float smooth_step(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

Vec3f Lighting::backdrop(const Vec3f& direction) const {
  const float height = std::sqrt(std::min(std::abs(direction.y()), 1.0f));
  return horizon + height * ((direction.y() >= 0 ? zenith : below) - horizon);
}

Vec3f Lighting::sky(const Vec3f& direction) const {
  return backdrop(direction) + smooth_step(0.5f, 0.9f, direction.dot(softbox_direction)) * softbox;
}

Vec3f Lighting::open_irradiance(const Vec3f& normal) const {
  const Vec3f sky_part = kPi * (0.5f * backdrop(normal) + 0.5f * horizon);
  return sky_part + std::max(0.0f, normal.dot(sun_direction)) * sun_irradiance;
}

Lighting make_lighting(const scenes::RenderSpec& settings) {
  const double length = settings.light_direction.norm();
  if (!std::isfinite(length) || !(length > 0)) {
    throw InputError("render.light_direction must be a direction towards the light, not zero");
  }
  if (!(settings.light_size >= 0 && settings.light_size <= 90)) {
    throw InputError(fmt::format("render.light_size is {}: expected 0 to 90 degrees", settings.light_size));
  }
  Lighting lighting;
  lighting.sun_direction = (settings.light_direction / length).cast<float>();
  lighting.sun_radius = float(settings.light_size) * kPi / 360;
  lighting.sun_irradiance = 1.05f * kPi * Vec3f(1.0f, 0.95f, 0.86f);
  lighting.horizon = Vec3f(0.46f, 0.50f, 0.56f);
  lighting.zenith = Vec3f(0.17f, 0.23f, 0.34f);
  lighting.below = Vec3f(0.22f, 0.22f, 0.22f);
  lighting.softbox = Vec3f(0.55f, 0.58f, 0.62f);
  // Opposite the sun and high, so that the side in shade has a sheen as well.
  lighting.softbox_direction =
      Vec3f(-lighting.sun_direction.x(), 0.9f, -0.3f * lighting.sun_direction.z()).normalized();
  return lighting;
}

float Ground::intersect(const Vec3f& origin, const Vec3f& direction) const {
  if (!visible || direction.y() >= 0 || origin.y() <= height) return std::numeric_limits<float>::infinity();
  return (height - origin.y()) / direction.y();
}

float Ground::fade(const Vec3f& point) const { return smooth_step(fade_start, fade_end, (point - center).norm()); }

Vec3f environment(const Lighting& lighting, const Ground& ground, const Vec3f& origin, const Vec3f& direction) {
  const float distance = ground.intersect(origin, direction);
  if (distance == std::numeric_limits<float>::infinity()) return lighting.sky(direction);
  const float fade = ground.fade(origin + distance * direction);
  // Half of the light: near an object the ground lies partly in its shadow.
  const Vec3f reflected = 0.6f / kPi * ground.reflectance.cwiseProduct(lighting.open_irradiance(Vec3f::UnitY()));
  return reflected + fade * (lighting.horizon - reflected);
}

}  // namespace flowskin::tools
