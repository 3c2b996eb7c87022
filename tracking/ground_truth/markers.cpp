#include "tracking/ground_truth/markers.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "tracking/advection/projection.h"
#include "tracking/velocity/moving_least_squares.h"

namespace flowskin::tracking {

Flow particle_flow(MetaballField field) {
  const auto shared = std::make_shared<const MetaballField>(std::move(field));
  return [shared](const Vec3& x) { return local_flow(*shared, x).velocity; };
}

FlowAt particle_flow(const ParticlePaths& paths, const FieldSettings& settings) {
  FieldSettings particles_alone = settings;
  particles_alone.wall_share = 0;
  return [&paths, particles_alone](double time) { return particle_flow(paths.field(time, particles_alone)); };
}

int Markers::on_surface() const { return static_cast<int>(std::count(left.begin(), left.end(), std::uint8_t{0})); }

Markers start_markers(const SurfaceMesh& mesh, double time, int most) {
  const auto count = static_cast<int>(mesh.positions.size());
  const int every = std::max(1, (count + most - 1) / std::max(1, most));
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return mesh.ids[a] < mesh.ids[b]; });
  Markers markers;
  markers.time = time;
  for (int i = 0; i < count; i += every) {
    markers.ids.push_back(mesh.ids[order[i]]);
    markers.rest_positions.push_back(mesh.rest_positions[order[i]]);
    markers.positions.push_back(mesh.positions[order[i]]);
  }
  markers.normals.assign(markers.ids.size(), Vec3::Zero());
  markers.depths.assign(markers.ids.size(), 0.0);
  markers.left.assign(markers.ids.size(), 0);
  return markers;
}

void advect_markers(const FlowAt& flow_at, double time, int steps, Markers& markers) {
  const double begin = markers.time;
  const double step = (time - begin) / steps;
  const auto count = static_cast<int>(markers.positions.size());
  Flow first = flow_at(begin);
  for (int k = 0; k < steps; ++k) {
    const Flow middle = flow_at(begin + (k + 0.5) * step);
    const Flow last = flow_at(k + 1 == steps ? time : begin + (k + 1) * step);
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < count; ++i) {
      if (markers.left[i]) continue;
      Vec3& x = markers.positions[i];
      const Vec3 k1 = first(x);
      const Vec3 k2 = middle(x + 0.5 * step * k1);
      const Vec3 k3 = middle(x + 0.5 * step * k2);
      const Vec3 k4 = last(x + step * k3);
      x += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    first = last;
  }
  markers.time = time;
}

void settle_markers(const ImplicitField& field, double most_depth, Markers& markers) {
  const auto count = static_cast<int>(markers.positions.size());
#pragma omp parallel for schedule(dynamic, 64)
  for (int i = 0; i < count; ++i) {
    if (markers.left[i]) continue;
    const SurfaceDistance point = surface_distance(field, markers.positions[i]);
    markers.normals[i] = point.normal;
    markers.depths[i] = point.distance;
    if (!(point.distance <= most_depth)) markers.left[i] = 1;
  }
}

}  // namespace flowskin::tracking
