#include "tracking/advection/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flowskin::tracking {
namespace {

constexpr int kHalvings = 6;
// Below this gradient (in units of weight / radius) the field is silent: the direction to the surface is noise.
constexpr double kSilentGradient = 1e-9;

SurfaceDistance describe(double f, const Vec3& gradient, const FieldSettings& settings) {
  SurfaceDistance point;
  const double slope = gradient.norm();
  point.distance = std::numeric_limits<double>::infinity();
  if (slope > kSilentGradient * settings.weight / settings.radius) {
    point.normal = -gradient / slope;
    point.distance = std::abs(f) / slope;
  }
  return point;
}

}  // namespace

ProjectionSettings default_projection(const FieldSettings& field) {
  ProjectionSettings settings;
  settings.tolerance = 1e-7 * field.radius;
  settings.max_step = 0.25 * field.radius;
  settings.max_distance = field.radius;
  return settings;
}

SurfaceDistance surface_distance(const MetaballField& field, const Vec3& x) {
  Vec3 gradient = Vec3::Zero();
  const double f = field.value(x, gradient);
  return describe(f, gradient, field.settings());
}

bool project_point(const MetaballField& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point) {
  Vec3 gradient = Vec3::Zero();
  Vec3 current = x;
  double f = field.value(current, gradient);
  const SurfaceDistance start = point = describe(f, gradient, field.settings());
  for (int iteration = 0; iteration < settings.max_iterations && point.distance > settings.tolerance; ++iteration) {
    if (!std::isfinite(point.distance)) break;
    Vec3 step = (f > 0 ? 1 : -1) * std::min(point.distance, settings.max_step) * point.normal;  // [FMM13, Eq. 12]
    bool progress = false;
    for (int halving = 0; halving < kHalvings && !progress; ++halving, step /= 2) {
      Vec3 next_gradient = Vec3::Zero();
      const double next = field.value(current + step, next_gradient);
      if (std::abs(next) >= std::abs(f)) continue;
      progress = true;
      current += step;
      f = next;
      gradient = next_gradient;
    }
    point = describe(f, gradient, field.settings());
    if (!progress || (current - x).norm() > settings.max_distance) break;
  }
  if (point.distance <= settings.tolerance && (current - x).norm() <= settings.max_distance) {
    x = current;
    return true;
  }
  point = start;
  return false;
}

Projection project_to_surface(const MetaballField& field, const ProjectionSettings& settings,
                              std::vector<Vec3>& positions) {
  const int count = static_cast<int>(positions.size());
  Projection result;
  result.normals.resize(count);
  std::vector<double> distances(count);
  std::vector<char> reached(count);
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < count; ++v) {
    SurfaceDistance point;
    reached[v] = project_point(field, settings, positions[v], point);
    result.normals[v] = point.normal;
    distances[v] = point.distance;
  }
  for (int v = 0; v < count; ++v) {
    result.max_distance = std::max(result.max_distance, distances[v]);
    if (!reached[v]) result.failed.push_back(v);
  }
  return result;
}

}  // namespace flowskin::tracking
