#include "sph/boundary_particles.h"

#include "sph/boundary_sampling.h"
#include "sph/hilbert_order.h"

namespace flowskin::sph {

BoundaryParticles sample_boundaries(const std::vector<Boundary>& boundaries, const SolverSettings& settings,
                                    const WallKernel& wall, const PeriodicBox& periodic) {
  BoundaryParticles result;
  std::vector<TriangleMesh> meshes;
  for (const Boundary& boundary : boundaries) {
    meshes.push_back(periodic.clip(boundary.mesh));
    for (const Vec3& p : sample_surface(meshes.back(), wall.sample_spacing, periodic)) {
      result.positions.push_back(p);
      result.slips.push_back(boundary.slip);
    }
  }
  result.volumes = boundary_volumes(result.positions, settings.kernel, wall.support, periodic);
  for (double& volume : result.volumes) volume *= wall.volume_factor;
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
         packs.capacity() * sizeof(WallPack) + clusters.memory_bytes() + guard.memory_bytes();
}

}  // namespace flowskin::sph
