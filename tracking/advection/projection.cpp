#include "tracking/advection/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace flowskin::tracking {
namespace {

constexpr int kHalvings = 6;
constexpr double kUsualSlack = 0.1;  // lengths of the scale
// Below this gradient (in units of the field's scale) the field is silent: the direction to the surface is noise.
constexpr double kSilentGradient = 1e-9;

SurfaceDistance describe(double f, const Vec3& gradient, const FieldScale& scale) {
  SurfaceDistance point;
  const double slope = gradient.norm();
  point.distance = std::numeric_limits<double>::infinity();
  if (slope > kSilentGradient * scale.value / scale.length) {
    point.normal = -gradient / slope;
    point.distance = std::abs(f) / slope;
  }
  return point;
}

template <class Field>
SurfaceDistance distance_at(const Field& field, const Vec3& x) {
  Vec3 gradient = Vec3::Zero();
  const double f = field.value(x, gradient);
  return describe(f, gradient, field.scale());
}

template <class Field>
bool project(const Field& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point) {
  Vec3 gradient = Vec3::Zero();
  Vec3 current = x;
  double f = field.value(current, gradient);
  const SurfaceDistance start = point = describe(f, gradient, field.scale());
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
    point = describe(f, gradient, field.scale());
    if (!progress || (current - x).norm() > settings.max_distance) break;
  }
  if (point.distance <= settings.tolerance && (current - x).norm() <= settings.max_distance) {
    x = current;
    return true;
  }
  point = start;
  return false;
}

// Projects the vertices `moved`, whose neighbourhoods these are in this order.
void project_some(const Neighborhoods& neighborhoods, const ProjectionSettings& settings, const std::vector<int>& moved,
                  std::vector<Vec3>& positions, Projection& projection) {
  std::vector<char> reached(moved.size());
  neighborhoods.for_each([&](int i, const LocalField& local) {
    const int v = moved[i];
    SurfaceDistance point;
    reached[i] = project(local, settings, positions[v], point);
    projection.normals[v] = point.normal;
    projection.distances[v] = point.distance;
  });
  projection.failed.clear();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!reached[i]) projection.failed.push_back(moved[i]);
  }
  const auto largest = std::max_element(projection.distances.begin(), projection.distances.end());
  projection.max_distance = largest != projection.distances.end() ? *largest : 0;
}

}  // namespace

ProjectionSettings default_projection(const FieldScale& scale) {
  ProjectionSettings settings;
  settings.tolerance = 1e-7 * scale.length;
  settings.max_step = 0.25 * scale.length;
  settings.max_distance = scale.length;
  return settings;
}

SurfaceDistance surface_distance(const ImplicitField& field, const Vec3& x) { return distance_at(field, x); }
SurfaceDistance surface_distance(const LocalField& field, const Vec3& x) { return distance_at(field, x); }

double largest_distance(const ImplicitField& field, const std::vector<Vec3>& points) {
  std::vector<double> distances(points.size());
  Neighborhoods(field, points).for_each([&](int i, const LocalField& local) {
    distances[i] = distance_at(local, points[i]).distance;
  });
  return distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
}

bool project_point(const ImplicitField& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point) {
  return project(field, settings, x, point);
}

bool project_point(const LocalField& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point) {
  return project(field, settings, x, point);
}

double usual_slack(const FieldScale& scale) { return kUsualSlack * scale.length; }

Projection project_to_surface(const ImplicitField& field, const ProjectionSettings& settings,
                              std::vector<Vec3>& positions) {
  return project_to_surface(Neighborhoods(field, positions, usual_slack(field.scale())), settings, positions);
}

Projection project_to_surface(const Neighborhoods& neighborhoods, const ProjectionSettings& settings,
                              std::vector<Vec3>& positions) {
  Projection result;
  result.normals.resize(positions.size());
  result.distances.resize(positions.size());
  std::vector<int> all(positions.size());
  std::iota(all.begin(), all.end(), 0);
  project_some(neighborhoods, settings, all, positions, result);
  return result;
}

void project_moved(const ImplicitField& field, const ProjectionSettings& settings, const std::vector<int>& moved,
                   std::vector<Vec3>& positions, Projection& projection) {
  std::vector<Vec3> starts(moved.size());
  for (std::size_t i = 0; i < moved.size(); ++i) starts[i] = positions[moved[i]];
  project_some(Neighborhoods(field, starts, usual_slack(field.scale())), settings, moved, positions, projection);
}

}  // namespace flowskin::tracking
