#include "scenes/sources/wall_points.h"

#include <memory>

#include "sph/walls/boundary_sampling.h"
#include "sph/walls/wall_reach.h"
#include "tracking/field/metaballs/field_walls.h"

namespace flowskin::scenes {
namespace {

void append(const sph::TriangleMesh& mesh, sph::TriangleMesh& whole) {
  const int first = static_cast<int>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const auto& [a, b, c] : mesh.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

tracking::Walls sample_walls(const Scene& scene) {
  if (!scene.tracking.enabled || !(scene.tracking.field.wall_share > 0)) return {};
  const double spacing = scene.particles.spacing;
  tracking::Walls resting, moving;
  sph::SolverSettings settings = scene.solver;
  settings.spacing = spacing;
  const sph::Box reach = sph::wall_reach(settings);
  sph::WallCount count(spacing, spacing);
  const auto add = [&](const sph::TriangleMesh& mesh, const KeyframeMotion& motion, tracking::Walls& walls) {
    if (mesh.triangles.empty()) return;
    const sph::Box place = motion.moves() ? sph::everywhere() : reach;
    count.add(mesh, place, "the field's wall");
    walls.push_back(std::make_shared<const tracking::Wall>(sph::sample_surface(mesh, spacing, {}, place),
                                                           spacing * spacing, motion));
  };
  // Resting walls together: where two have a face in common it counts once.
  sph::TriangleMesh rest;
  for (const BoundarySpec& wall : scene.boundaries) {
    if (wall.boundary.motion.moves()) {
      add(wall.boundary.mesh, wall.boundary.motion, moving);
    } else {
      append(wall.boundary.mesh, rest);
    }
  }
  add(rest, {}, resting);
  resting.insert(resting.end(), moving.begin(), moving.end());
  return resting;
}

}  // namespace flowskin::scenes
