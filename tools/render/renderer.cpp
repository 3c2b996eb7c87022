#include "tools/render/renderer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/bounds.h"
#include "common/errors.h"
#include "tools/render/camera.h"
#include "tools/render/film.h"
#include "tools/render/lighting.h"
#include "tools/render/sampling.h"
#include "tools/render/subject.h"
#include "tools/render/trace_scene.h"

namespace flowskin::tools {

// A sample of the scene without its subject: the same in every frame, so it is traced once and kept.
struct StaticSample {
  float distance = std::numeric_limits<float>::infinity();
  std::array<std::int16_t, 3> normal{0, 0, 0};  // times 32767
  std::uint16_t object = kNoObject;
  bool sees_sun = false;      // along this sample's direction
  std::uint8_t sees_sky = 0;  // a bit for each of its directions
};

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Which surface a sample lies on; walls follow from kFirstWall on.
constexpr std::uint32_t kGroundObject = 1, kSubjectObject = 2, kFirstWall = 3;

// Directions towards the sky for each sample; one suffices where a pixel has many samples.
int sky_rays_for(int samples) { return samples <= 16 ? 2 : 1; }

// Above this number of samples a picture (192 MB) they are traced again for each frame.
constexpr std::size_t kMaxKeptSamples = 16'000'000;

// The fluid's coat reflects as a dielectric with 4 % at normal incidence (C. Schlick 1994).
float fresnel(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f), m2 = m * m;
  return 0.04f + 0.96f * m2 * m2 * m;
}

// Highlight of the sun on the coat, divided by its irradiance: microfacets of Trowbridge and Reitz, made rougher by the
// size of the sun (B. Karis, "Real Shading in Unreal Engine 4", 2013).
float highlight(const Vec3f& normal, const Vec3f& view, const Vec3f& light, float sun_radius) {
  const float n_l = normal.dot(light), n_v = std::max(normal.dot(view), 1e-3f);
  if (n_l <= 0) return 0;
  const Vec3f half = (view + light).normalized();
  const float alpha = std::min(1.0f, 0.05f + 0.5f * std::tan(sun_radius)), a2 = alpha * alpha;
  const float n_h = std::max(normal.dot(half), 0.0f), d = n_h * n_h * (a2 - 1) + 1;
  const float lambda_v = n_l * std::sqrt(n_v * n_v * (1 - a2) + a2),
              lambda_l = n_v * std::sqrt(n_l * n_l * (1 - a2) + a2);
  return fresnel(view.dot(half)) * a2 / (kPi * d * d) * 0.5f / (lambda_v + lambda_l) * n_l;
}

void check_settings(const scenes::RenderSpec& settings) {
  constexpr int max_size = 16384, max_samples = 4096;
  if (settings.width < 1 || settings.height < 1 || settings.width > max_size || settings.height > max_size) {
    throw InputError(fmt::format("render.width and render.height are {} and {}: expected 1 to {} pixels",
                                 settings.width, settings.height, max_size));
  }
  if (settings.samples < 1 || settings.samples > max_samples) {
    throw InputError(fmt::format("render.samples is {}: expected 1 to {} per pixel", settings.samples, max_samples));
  }
  if (!(settings.exposure > 0 && std::isfinite(settings.exposure))) {
    throw InputError(fmt::format("render.exposure is {}: expected a positive number", settings.exposure));
  }
}

// The places that a camera should see: the corners of the visible walls and of the fluid's box.
std::vector<Vec3> points_to_see(const std::vector<scenes::BoundarySpec>& boundaries, const sph::Box& fluid) {
  std::vector<Vec3> points;
  for (const auto& boundary : boundaries) {
    if (!boundary.visible) continue;
    const auto see = [&](double time) {
      for (const Vec3& position : sph::placed(boundary.boundary.mesh, boundary.boundary.motion, time).positions)
        points.push_back(position);
    };
    if (!boundary.boundary.motion.moves()) see(0);
    for (const sph::Keyframe& key : boundary.boundary.motion.keyframes) see(key.time);
  }
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(k & 1 ? fluid.max.x() : fluid.min.x(), k & 2 ? fluid.max.y() : fluid.min.y(),
                        k & 4 ? fluid.max.z() : fluid.min.z());
  }
  return points;
}

sph::Box bounding_box(const std::vector<Vec3>& points) {
  for (const Vec3& point : points) {
    if (!point.allFinite())
      throw InputError("the walls or the fluid of the scene to draw have a place that is not finite");
  }
  return bounds(points);
}

}  // namespace

struct Renderer::Impl {
  Impl(const scenes::RenderSpec& spec, const std::vector<scenes::BoundarySpec>& boundaries, const Image& image,
       const std::vector<Vec3>& seen, const sph::Box& box);

  Image draw(const Subject& subject) const;
  /// Puts walls that move to where they are at `time` (s).
  void place_walls(double time);
  Style style() const { return style_; }

  TraceDevice device;
  Vec3 origin;
  MipMap texture;

 private:
  void add_walls(const std::vector<scenes::BoundarySpec>& boundaries, double time);
  void keep_static_samples();

  std::size_t light_index(int x, int y, int sample) const {
    return std::size_t(interleaved_set(x, y)) * std::size_t(settings_.samples) + std::size_t(sample);
  }
  Vec3f direction(int x, int y, int sample) const {
    const Vec2f& offset = pixel_offsets_[std::size_t(sample)];
    return camera_.direction(float(x) + offset.x(), float(y) + offset.y());
  }
  Vec3f sky_direction(const Vec3f& normal, std::size_t light, int k) const {
    return rotate_to(normal, sky_directions_[light * std::size_t(sky_rays_) + std::size_t(k)]);
  }
  StaticSample trace_static(int x, int y, int sample) const;
  Sample shade_static(const StaticSample& fixed, const Subject& subject, const Vec3f& ray, std::size_t light) const;
  Sample shade_subject(const RayHit& hit, const Subject& subject, const Vec3f& ray, std::size_t light) const;
  Vec3f reflection(const Subject& subject, const Vec3f& from, const Vec3f& ray) const;
  Vec3f wall_light(std::uint32_t object, const Vec3f& normal) const;
  Vec3f blocked_radiance() const { return 0.22f * lighting_.horizon; }

  scenes::RenderSpec settings_;
  Style style_;
  Lighting lighting_;
  Ground ground_;
  Camera camera_;
  TraceScene walls_;
  std::vector<Vec3f> wall_reflectance_;
  std::vector<scenes::BoundarySpec> moving_scene_;  // all walls where some of them move, else empty
  double wall_time_ = 0;                            // s
  int sky_rays_;
  float step_off_;  // m: how far from a surface a secondary ray starts
  std::vector<Vec2f> pixel_offsets_;
  std::vector<Vec3f> sun_directions_, sky_directions_;  // interleaved_sets * samples (* sky_rays_); the sky's about +z
  std::vector<StaticSample> static_samples_;            // empty where they would be too many
};

Renderer::Impl::Impl(const scenes::RenderSpec& spec, const std::vector<scenes::BoundarySpec>& boundaries,
                     const Image& image, const std::vector<Vec3>& seen, const sph::Box& box)
    : origin((box.min + box.max) / 2),
      texture(image),
      settings_(spec),
      style_(style_from_name(spec.style)),
      lighting_(make_lighting(spec)),
      camera_(place_camera(spec.camera, double(spec.width) / spec.height, seen), spec.width, spec.height, origin),
      walls_(device),
      sky_rays_(sky_rays_for(spec.samples)) {
  const float size = std::max(float((box.max - box.min).norm()), 1e-6f);
  step_off_ = 1e-4f * size;
  ground_.visible = spec.ground;
  ground_.height = float(spec.ground_height - origin.y());
  for (int i = 0; i < 3; ++i) ground_.reflectance[i] = float(spec.ground_color[std::size_t(i)]);
  ground_.fade_start = 0.6f * size;
  ground_.fade_end = 3.5f * size;
  add_walls(boundaries, wall_time_);
  if (std::any_of(boundaries.begin(), boundaries.end(),
                  [](const auto& b) { return b.visible && b.boundary.motion.moves(); })) {
    moving_scene_ = boundaries;
  }
  const int sets = kInterleavedSets * spec.samples;
  pixel_offsets_ = scrambled_sobol(spec.samples, 1);
  sun_directions_ = cone_directions(sets, 2, lighting_.sun_direction, lighting_.sun_radius);
  sky_directions_ = cosine_hemisphere(sets * sky_rays_, 3);
  keep_static_samples();
}

void Renderer::Impl::place_walls(double time) {
  if (moving_scene_.empty() || time == wall_time_) return;
  wall_time_ = time;
  walls_ = TraceScene(device);
  wall_reflectance_.clear();
  add_walls(moving_scene_, time);
  keep_static_samples();
}

void Renderer::Impl::add_walls(const std::vector<scenes::BoundarySpec>& boundaries, double time) {
  for (const auto& boundary : boundaries) {
    if (!boundary.visible) continue;
    std::vector<Vec3f> positions;
    const sph::TriangleMesh mesh = sph::placed(boundary.boundary.mesh, boundary.boundary.motion, time);
    for (const Vec3& position : mesh.positions) positions.push_back((position - origin).cast<float>());
    for (const auto& triangle : mesh.triangles) {
      for (const int corner : triangle) {
        if (corner < 0 || std::size_t(corner) >= positions.size()) {
          throw InputError(fmt::format("a wall to draw names vertex {} of {}", corner, positions.size()));
        }
      }
    }
    walls_.add_triangles(positions, mesh.triangles);
    wall_reflectance_.emplace_back(float(boundary.color[0]), float(boundary.color[1]), float(boundary.color[2]));
  }
  walls_.commit();
}

void Renderer::Impl::keep_static_samples() {
  const std::size_t count =
      std::size_t(settings_.width) * std::size_t(settings_.height) * std::size_t(settings_.samples);
  if (count > kMaxKeptSamples) return;
  static_samples_.resize(count);
#pragma omp parallel
  {
    const FlushDenormals flush;
#pragma omp for schedule(dynamic, 4)
    for (int y = 0; y < settings_.height; ++y) {
      StaticSample* out =
          &static_samples_[std::size_t(y) * std::size_t(settings_.width) * std::size_t(settings_.samples)];
      for (int x = 0; x < settings_.width; ++x) {
        for (int s = 0; s < settings_.samples; ++s) *out++ = trace_static(x, y, s);
      }
    }
  }
}

StaticSample Renderer::Impl::trace_static(int x, int y, int sample) const {
  const Vec3f ray = direction(x, y, sample);
  StaticSample result;
  Vec3f normal = Vec3f::UnitY();
  result.distance = ground_.intersect(camera_.position(), ray);
  if (result.distance < kInfinity) result.object = kGroundObject;
  RayHit hit;
  // A floor drawn at the height of the ground hides it.
  if (walls_.intersect(camera_.position(), ray, 0, result.distance * 1.0001f, hit)) {
    result.distance = hit.distance;
    result.object = std::uint16_t(std::min(kFirstWall + hit.geometry, 65535u));
    normal = hit.normal.dot(ray) > 0 ? Vec3f(-hit.normal) : hit.normal;  // walls have two sides
  }
  if (result.object == kNoObject) return result;
  for (int i = 0; i < 3; ++i) result.normal[std::size_t(i)] = std::int16_t(std::lround(32767 * normal[i]));
  const Vec3f from = camera_.position() + result.distance * ray + step_off_ * normal;
  const std::size_t light = light_index(x, y, sample);
  const Vec3f& sun = sun_directions_[light];
  result.sees_sun = normal.dot(sun) > 0 && !walls_.occluded(from, sun, 0, kInfinity);
  for (int k = 0; k < sky_rays_; ++k) {
    const bool open = !walls_.occluded(from, sky_direction(normal, light, k), 0, kInfinity);
    result.sees_sky = std::uint8_t(result.sees_sky | (open ? 1 << k : 0));
  }
  return result;
}

Sample Renderer::Impl::shade_static(const StaticSample& fixed, const Subject& subject, const Vec3f& ray,
                                    std::size_t light) const {
  Sample sample;
  sample.object = fixed.object;
  if (fixed.object == kNoObject) {
    sample.extra = lighting_.backdrop(ray);
    return sample;
  }
  sample.point = camera_.position() + fixed.distance * ray;
  sample.normal = Vec3f(fixed.normal[0], fixed.normal[1], fixed.normal[2]).normalized();
  sample.spacing = fixed.distance * std::sqrt(camera_.pixel_solid_angle());
  sample.reflectance =
      fixed.object == kGroundObject ? ground_.reflectance : wall_reflectance_[fixed.object - kFirstWall];
  if (fixed.object == kGroundObject) {
    const float fade = ground_.fade(sample.point);
    sample.reflectance *= 1 - fade;
    sample.extra = fade * lighting_.backdrop(Vec3f(ray.x(), 0, ray.z()));
    if (fade >= 1) return sample;
  }
  const Vec3f from = sample.point + step_off_ * sample.normal;
  const float sky_share = kPi / float(sky_rays_);
  const Vec3f& sun = sun_directions_[light];
  if (fixed.sees_sun && !subject.scene().occluded(from, sun, 0, kInfinity)) {
    sample.irradiance = sample.normal.dot(sun) * lighting_.sun_irradiance;
  }
  for (int k = 0; k < sky_rays_; ++k) {
    const Vec3f sky = sky_direction(sample.normal, light, k);
    const bool open = (fixed.sees_sky >> k & 1) != 0 && !subject.scene().occluded(from, sky, 0, kInfinity);
    sample.irradiance += sky_share * (open ? environment(lighting_, ground_, from, sky) : blocked_radiance());
  }
  return sample;
}

Sample Renderer::Impl::shade_subject(const RayHit& hit, const Subject& subject, const Vec3f& ray,
                                     std::size_t light) const {
  Sample sample;
  sample.object = kSubjectObject;
  sample.point = camera_.position() + hit.distance * ray;
  const Vec3f facing = hit.normal.dot(ray) > 0 ? Vec3f(-hit.normal) : hit.normal;
  const float pixel_area = hit.distance * hit.distance * camera_.pixel_solid_angle();
  const float footprint = pixel_area / float(settings_.samples) / std::max(-facing.dot(ray), 0.05f);
  const Material material = subject.material(hit, sample.point, footprint);
  if (material.unlit) {
    sample.unlit = material.reflectance;
    return sample;
  }
  sample.normal = material.normal;
  sample.spacing = std::sqrt(pixel_area);
  const Vec3f from = sample.point + material.lift + step_off_ * facing;
  const auto blocked = [&](const Vec3f& direction) {
    return subject.scene().occluded(from, direction, 0, kInfinity) || walls_.occluded(from, direction, 0, kInfinity);
  };
  const float sky_share = kPi / float(sky_rays_);
  const Vec3f& sun = sun_directions_[light];
  const float sun_cosine = sample.normal.dot(sun);
  const Vec3f view = -ray;
  if (sun_cosine > 0 && !blocked(sun)) {
    sample.irradiance = sun_cosine * lighting_.sun_irradiance;
    sample.extra =
        highlight(sample.normal, view, lighting_.sun_direction, lighting_.sun_radius) * lighting_.sun_irradiance;
  }
  for (int k = 0; k < sky_rays_; ++k) {
    const Vec3f sky = sky_direction(sample.normal, light, k);
    sample.irradiance += sky_share * (blocked(sky) ? blocked_radiance() : environment(lighting_, ground_, from, sky));
  }
  // The coat: what it mirrors does not reach the colour below.
  const float mirrored = fresnel(sample.normal.dot(view));
  const Vec3f mirror = (ray - 2 * ray.dot(sample.normal) * sample.normal).normalized();
  sample.extra += mirrored * reflection(subject, from, mirror);
  sample.extra = sample.extra.cwiseMin(4);  // else a few bright samples make jagged edges
  sample.reflectance = (1 - mirrored) * material.reflectance;
  return sample;
}

// Light that a wall or the ground gives back, its own shadows left out.
Vec3f Renderer::Impl::wall_light(std::uint32_t object, const Vec3f& normal) const {
  return 0.7f / kPi * wall_reflectance_[object - kFirstWall].cwiseProduct(lighting_.open_irradiance(normal));
}

Vec3f Renderer::Impl::reflection(const Subject& subject, const Vec3f& from, const Vec3f& ray) const {
  RayHit hit;
  float nearest = ground_.intersect(from, ray);
  Vec3f light = environment(lighting_, ground_, from, ray);
  if (walls_.intersect(from, ray, 0, nearest, hit)) {
    nearest = hit.distance;
    light = wall_light(kFirstWall + hit.geometry, hit.normal.dot(ray) > 0 ? Vec3f(-hit.normal) : hit.normal);
  }
  if (subject.scene().intersect(from, ray, 0, nearest, hit)) {
    const Material material = subject.material(hit, from + hit.distance * ray, 16 * hit.distance * step_off_);
    light = 0.5f / kPi * material.reflectance.cwiseProduct(lighting_.open_irradiance(material.normal));
  }
  return light;
}

Image Renderer::Impl::draw(const Subject& subject) const {
  Film film(settings_.width, settings_.height);
#pragma omp parallel
  {
    const FlushDenormals flush;
    std::vector<Sample> samples(static_cast<std::size_t>(settings_.samples));
#pragma omp for schedule(dynamic, 4)
    for (int y = 0; y < settings_.height; ++y) {
      for (int x = 0; x < settings_.width; ++x) {
        const std::size_t pixel = std::size_t(y) * std::size_t(settings_.width) + std::size_t(x);
        for (int s = 0; s < settings_.samples; ++s) {
          const StaticSample fixed = static_samples_.empty()
                                         ? trace_static(x, y, s)
                                         : static_samples_[pixel * std::size_t(settings_.samples) + std::size_t(s)];
          const Vec3f ray = direction(x, y, s);
          const std::size_t light = light_index(x, y, s);
          RayHit hit;
          const bool met = subject.scene().intersect(camera_.position(), ray, 0, fixed.distance, hit);
          samples[std::size_t(s)] =
              met ? shade_subject(hit, subject, ray, light) : shade_static(fixed, subject, ray, light);
        }
        film.set_pixel(x, y, samples);
      }
    }
  }
  return film.develop(settings_.samples <= 16, float(settings_.exposure));
}

Renderer::Renderer(const scenes::RenderSpec& settings, const std::vector<scenes::BoundarySpec>& boundaries,
                   const Image& texture, const sph::Box& fluid) {
  check_settings(settings);
  const std::vector<Vec3> seen = points_to_see(boundaries, fluid);
  impl_ = std::make_unique<Impl>(settings, boundaries, texture, seen, bounding_box(seen));
}

Renderer::~Renderer() = default;

Image Renderer::draw(const SurfaceFrame& frame) const {
  impl_->place_walls(frame.time);
  return impl_->draw(SurfaceSubject(impl_->device, frame, impl_->style(), impl_->texture, impl_->origin));
}

Image Renderer::draw(const ParticleFrame& frame) const {
  impl_->place_walls(frame.state.time);
  return impl_->draw(ParticleSubject(impl_->device, frame, impl_->origin));
}

}  // namespace flowskin::tools
