#include "tools/pipeline/volume_outside_walls.h"

#include <utility>

#include "common/closest_point.h"
#include "common/parallel.h"
#include "sph/geometry/mesh_inside.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools {

struct WallSolids::Solid {
  explicit Solid(const sph::Boundary& boundary)
      : mesh(boundary.mesh), motion(boundary.motion), closest(mesh.positions, mesh.triangles), is_inside(mesh) {}

  /// Where a point goes that is less than `reach` within; any other stays. Both in the mesh's own place.
  Vec3 put_out(const Vec3& p, double reach) const {
    const MeshPoint found = closest.closest(p, reach);
    if (found.triangle < 0 || !is_inside(p)) return p;
    Vec3 onto = Vec3::Zero();
    for (int k = 0; k < 3; ++k) onto += found.weights[k] * mesh.positions[mesh.triangles[found.triangle][k]];
    return onto;
  }

  sph::TriangleMesh mesh;
  sph::BoundaryMotion motion;
  ClosestPointTree closest;
  sph::InsideTest is_inside;
};

WallSolids::WallSolids(const scenes::Scene& scene) : spacing_(scene.particles.spacing) {
  for (const scenes::BoundarySpec& wall : scene.boundaries)
    if (!wall.boundary.hollow && sph::is_closed(wall.boundary.mesh))
      solids_.push_back(std::make_unique<Solid>(wall.boundary));
}

WallSolids::~WallSolids() = default;
WallSolids::WallSolids(WallSolids&&) noexcept = default;

double WallSolids::volume_outside(const tracking::SurfaceMesh& mesh, double time) const {
  std::vector<Vec3> positions = mesh.positions;
  for (const auto& solid : solids_) {
    const Pose pose = solid->motion.pose(time);
#pragma omp parallel for schedule(static) num_threads(threads_for(positions.size()))
    for (std::ptrdiff_t i = 0; i < std::ssize(positions); ++i)
      positions[i] = pose.place(solid->put_out(pose.to_rest(positions[i]), spacing_));
  }
  return tracking::mesh_volume(positions, mesh.triangles);
}

}  // namespace flowskin::tools
