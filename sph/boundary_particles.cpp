#include "sph/boundary_particles.h"

#include <algorithm>
#include <cmath>

#include "sph/boundary_sampling.h"
#include "sph/hilbert_order.h"

namespace flowskin::sph {

namespace {

// Volume V_b over the area of a boundary particle in a plane: 1 / (area sum W) over the square lattice.
double area_to_volume(const SolverSettings& settings, const WallKernel& wall) {
  const int reach = static_cast<int>(std::ceil(wall.support / wall.sample_spacing));
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      sum += kernel_value(settings.kernel, wall.sample_spacing * std::hypot(i, j), wall.support);
    }
  }
  return 1 / (wall.sample_spacing * wall.sample_spacing * sum);
}

}  // namespace

BoundaryParticles sample_boundaries(const std::vector<Boundary>& boundaries, const SolverSettings& settings,
                                    const WallKernel& wall, const PeriodicBox& periodic) {
  BoundaryParticles result;
  std::vector<TriangleMesh> meshes;
  std::vector<float> adhesions;
  for (const Boundary& boundary : boundaries) {
    meshes.push_back(periodic.clip(boundary.mesh));
    for (const Vec3& p : sample_surface(meshes.back(), wall.sample_spacing, periodic)) {
      result.positions.push_back(p);
      result.slips.push_back(boundary.slip);
      adhesions.push_back(static_cast<float>(boundary.adhesion));
    }
  }
  result.volumes = boundary_volumes(result.positions, settings.kernel, wall.support, periodic);
  if (std::any_of(adhesions.begin(), adhesions.end(), [](float a) { return a > 0; })) {
    const double thickness = area_to_volume(settings, wall);
    for (std::size_t b = 0; b < adhesions.size(); ++b) {
      adhesions[b] *= static_cast<float>(result.volumes[b] / thickness);
    }
    result.adhesions = std::move(adhesions);
  }
  if (!meshes.empty()) result.guard = WallGuard(meshes, 2 * settings.spacing, periodic);
  return result;
}

void place_at_origin(BoundaryParticles& boundary, const Vec3& origin, const WallKernel& wall) {
  const std::size_t count = boundary.positions.size();
  std::vector<Eigen::Vector3f> points(count);
  for (std::size_t b = 0; b < count; ++b) points[b] = (boundary.positions[b] - origin).cast<float>();
  HilbertOrder curve;
  curve.compute(points, static_cast<float>(wall.sample_spacing));

  std::vector<Vec3> positions(count);
  std::vector<double> volumes(count), slips(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t b = curve.order()[k];
    positions[k] = boundary.positions[b];
    volumes[k] = boundary.volumes[b];
    slips[k] = boundary.slips[b];
    points[k] = (positions[k] - origin).cast<float>();
  }
  boundary.positions = std::move(positions);
  std::vector<float> adhesions(boundary.adhesions.size());
  for (std::size_t k = 0; k < adhesions.size(); ++k) adhesions[k] = boundary.adhesions[curve.order()[k]];
  boundary.adhesions = std::move(adhesions);

  boundary.packs.resize(count);
  const double unit = wall.support * wall.support * wall.support;
  for (std::size_t k = 0; k < count; ++k) {
    boundary.packs[k] = {points[k].x(),
                         points[k].y(),
                         points[k].z(),
                         static_cast<float>(volumes[k] / unit),
                         static_cast<float>(1 - slips[k]),
                         {}};
  }
  boundary.volumes = {};
  boundary.slips = {};
  boundary.clusters.assign(points, static_cast<float>(6 * wall.sample_spacing));
}

std::size_t BoundaryParticles::memory_bytes() const {
  return positions.capacity() * sizeof(Vec3) + (volumes.capacity() + slips.capacity()) * sizeof(double) +
         adhesions.capacity() * sizeof(float) + packs.capacity() * sizeof(WallPack) + clusters.memory_bytes() +
         guard.memory_bytes();
}

}  // namespace flowskin::sph
