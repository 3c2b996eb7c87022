#include "sph/fluid_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "sph/mesh_inside.h"
#include "sph/point_grid.h"

namespace flowskin::sph {

namespace {

constexpr double body_distance = 0.7;       // in spacings, between particles of different bodies
constexpr double wall_distance = 0.499999;  // in spacings; a hair below half, so that a lattice on a wall is kept

// Lattice points of the box for which keep(point) holds.
template <typename Keep>
std::vector<Vec3> lattice(const Box& box, double spacing, Keep keep) {
  std::vector<Vec3> points;
  // The number of points (i + 1/2) spacing below the box's length.
  const Eigen::Array3i count = ((box.max - box.min) / spacing - Vec3::Constant(0.5 + 1e-9)).array().ceil().cast<int>();
  for (int i = 0; i < count.x(); ++i) {
    for (int j = 0; j < count.y(); ++j) {
      for (int k = 0; k < count.z(); ++k) {
        const Vec3 p = box.min + Vec3(i + 0.5, j + 0.5, k + 0.5) * spacing;
        if (keep(p)) points.push_back(p);
      }
    }
  }
  return points;
}

std::vector<Vec3> fill_block(const FluidBody& body, double spacing, const std::string& name) {
  if (!((body.block.max - body.block.min).minCoeff() > 0)) {
    throw SettingsError(name + " (block): its max corner must be greater than its min corner along every axis");
  }
  return lattice(body.block, spacing, [](const Vec3&) { return true; });
}

std::vector<Vec3> fill_ball(const FluidBody& body, double spacing, const std::string& name) {
  if (!(body.radius > 0)) throw SettingsError(name + " (ball): its radius must be greater than 0");
  const Vec3 reach = Vec3::Constant(std::ceil(body.radius / spacing) * spacing);  // symmetric about the centre
  return lattice({body.center - reach, body.center + reach}, spacing,
                 [&](const Vec3& p) { return (p - body.center).squaredNorm() < body.radius * body.radius; });
}

std::vector<Vec3> fill_mesh(const FluidBody& body, double spacing, const std::string& name) {
  if (body.mesh.triangles.empty()) throw SettingsError(name + " (mesh): the mesh has no triangles");
  if (!is_closed(body.mesh)) {
    throw SettingsError(name +
                        " (mesh): the mesh is not closed, so it has no inside; close its holes and make the "
                        "triangles' orientation consistent");
  }
  return lattice_points_inside(body.mesh, spacing);
}

std::vector<Vec3> fill(const FluidBody& body, double spacing, const std::string& name) {
  switch (body.shape) {
    case FluidBody::Shape::ball:
      return fill_ball(body, spacing, name);
    case FluidBody::Shape::mesh:
      return fill_mesh(body, spacing, name);
    case FluidBody::Shape::block:
      break;
  }
  return fill_block(body, spacing, name);
}

bool is_cut_out(const FluidBody& body, const Vec3& p) {
  return std::any_of(body.cuts.begin(), body.cuts.end(), [&](const Box& cut) {
    return (p.array() >= cut.min.array()).all() && (p.array() <= cut.max.array()).all();
  });
}

}  // namespace

std::vector<FluidPoint> fill_bodies(const std::vector<FluidBody>& bodies, double spacing,
                                    const std::vector<Vec3>& boundary_positions) {
  PointGrid walls(spacing), fluid(spacing);
  for (const Vec3& p : boundary_positions) walls.insert(p);

  std::vector<FluidPoint> points;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string name = "fluid body " + std::to_string(b + 1);
    std::vector<Vec3> positions = fill(bodies[b], spacing, name);
    if (positions.empty()) {
      throw SettingsError(name + " holds no particle: it is smaller than the spacing of " + std::to_string(spacing) +
                          " m");
    }
    std::erase_if(positions, [&](const Vec3& p) {
      return is_cut_out(bodies[b], p) || walls.has_near(p, wall_distance * spacing) ||
             fluid.has_near(p, body_distance * spacing);
    });
    if (positions.empty()) {
      throw SettingsError(name + " has no particle left: it is cut out whole, or lies in other bodies or on a wall");
    }
    Vec3 centroid = Vec3::Zero();
    for (const Vec3& p : positions) centroid += p / static_cast<double>(positions.size());
    for (const Vec3& p : positions) {
      points.push_back({p, bodies[b].velocity + bodies[b].angular_velocity.cross(p - centroid)});
      fluid.insert(p);
    }
  }
  return points;
}

}  // namespace flowskin::sph
