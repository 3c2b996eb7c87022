#include "tools/pipeline/field_walls.h"

#include <memory>
#include <utility>
#include <vector>

#include "sph/walls/boundary_motion.h"
#include "sph/walls/boundary_sampling.h"
#include "tools/frame_data.h"

namespace flowskin::tools {
namespace {

/// A wall that moves, and its points where its mesh is at rest.
struct Mover {
  sph::BoundaryMotion motion;
  std::vector<Vec3> points;

  std::shared_ptr<const tracking::FieldWall> at(double time, double share, double radius) const {
    const sph::Pose pose = motion.pose(time);
    std::vector<Vec3> positions;
    for (const Vec3& point : points) positions.push_back(pose.place(point));
    return std::make_shared<const tracking::FieldWall>(std::move(positions), share, radius);
  }
};

void append(const sph::TriangleMesh& mesh, sph::TriangleMesh& whole) {
  const int first = static_cast<int>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const auto& [a, b, c] : mesh.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

tracking::WallsAt field_walls(const scenes::Scene& scene, const tracking::FieldSettings& settings) {
  const double spacing = scene.particles.spacing;
  const double share = share_of_wall_point(settings, spacing * spacing, scene.tracking.wall_share);
  if (scene.boundaries.empty() || !(share > 0)) return {};
  // Resting walls together: where two have a face in common it counts once.
  sph::TriangleMesh resting;
  std::vector<Mover> movers;
  for (const scenes::BoundarySpec& wall : scene.boundaries) {
    if (wall.boundary.motion.moves()) {
      movers.push_back({wall.boundary.motion, sph::sample_surface(wall.boundary.mesh, spacing)});
    } else {
      append(wall.boundary.mesh, resting);
    }
  }
  tracking::FieldWalls rest;
  if (!resting.triangles.empty()) {
    rest.push_back(
        std::make_shared<const tracking::FieldWall>(sph::sample_surface(resting, spacing), share, settings.radius));
  }
  return [rest, movers, share, radius = settings.radius](double time) {
    tracking::FieldWalls walls = rest;
    for (const Mover& mover : movers) walls.push_back(mover.at(time, share, radius));
    return walls;
  };
}

}  // namespace flowskin::tools
