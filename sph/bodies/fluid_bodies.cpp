#include "sph/bodies/fluid_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/number_text.h"
#include "sph/geometry/mesh_inside.h"
#include "sph/neighbors/point_grid.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

constexpr double body_distance = 0.7;       // in spacings, between particles of different bodies
constexpr double wall_distance = 0.499999;  // in spacings; a hair below half, so that a lattice on a wall is kept

// Lattice points of the box for which keep(point) holds.
template <typename Keep>
std::vector<Vec3> lattice(const Box& box, double spacing, Keep keep) {
  std::vector<Vec3> points;
  // The number of points (i + 1/2) spacing below the box's length.
  const Eigen::Array3i count =
      ((box.max - box.min) / spacing - Vec3::Constant(0.5 + 1e-9)).array().ceil().min(1e9).cast<int>();
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

// Before memory is taken for what a stray vertex or a slip of the spacing asks for.
void check_size(const TriangleMesh& mesh, double spacing, const std::string& name) {
  constexpr double most_points = 2e10, most_rows = 5e7;
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      low = low.cwiseMin(mesh.positions[v]);
      high = high.cwiseMax(mesh.positions[v]);
    }
  }
  const Vec3 count = (high - low) / spacing + Vec3::Ones();
  if (count.prod() <= most_points && count.y() * count.z() <= most_rows) return;
  throw SettingsError(name + " (mesh): the box around its mesh, from (" + number_text(low.x(), 4) + ", " +
                      number_text(low.y(), 4) + ", " + number_text(low.z(), 4) + ") to (" + number_text(high.x(), 4) +
                      ", " + number_text(high.y(), 4) + ", " + number_text(high.z(), 4) + ") m, holds " +
                      number_text(count.prod(), 4) + " points at a spacing of " + number_text(spacing, 4) +
                      " m, too many to look at: make the spacing larger or the mesh smaller (does a vertex stray?)");
}

std::vector<Vec3> fill_mesh(const FluidBody& body, double spacing, const std::string& name) {
  if (body.mesh.triangles.empty()) throw SettingsError(name + " (mesh): the mesh has no triangles");
  if (!is_closed(body.mesh)) {
    throw SettingsError(name +
                        " (mesh): the mesh is not closed, so it has no inside; close its holes and make the "
                        "triangles' orientation consistent");
  }
  check_size(body.mesh, spacing, name);
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

// A lattice that fills a period must go on across the seam as if there were none.
void check_fits_period(const std::vector<Vec3>& positions, double spacing, const PeriodicBox& periodic,
                       const std::string& name) {
  for (int a = 0; a < 3 && !positions.empty(); ++a) {
    if (!periodic.along(a)) continue;
    double low = positions[0][a], high = low;
    for (const Vec3& p : positions) low = std::min(low, p[a]), high = std::max(high, p[a]);
    const double period = periodic.period()[a], excess = high - low + spacing - period;
    if (excess < -0.75 * spacing || std::abs(excess) < 1e-3 * spacing) continue;
    const double count = std::max(1.0, std::round(period / spacing));
    const std::string axis(1, static_cast<char>('x' + a));
    if (excess > 0.75 * spacing) {
      throw SettingsError(name + " is longer along " + axis + " than the period of " + number_text(period) + " m");
    }
    throw SettingsError(name + " fills the period of " + number_text(period) + " m along " + axis +
                        ", which is no whole number of spacings of " + number_text(spacing) +
                        " m; choose a spacing of " + number_text(period / count, 10) + " m, or another period");
  }
}

bool is_cut_out(const FluidBody& body, const Vec3& p) {
  return std::any_of(body.cuts.begin(), body.cuts.end(), [&](const Box& cut) {
    return (p.array() >= cut.min.array()).all() && (p.array() <= cut.max.array()).all();
  });
}

}  // namespace

std::vector<FluidPoint> fill_bodies(const std::vector<FluidBody>& bodies, double spacing,
                                    const std::vector<Vec3>& boundary_positions, const PeriodicBox& periodic) {
  PointGrid walls(spacing), fluid(spacing);
  for (const Vec3& p : boundary_positions) walls.insert(p);

  std::vector<FluidPoint> points;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string name = "fluid body " + std::to_string(b + 1);
    std::vector<Vec3> positions = fill(bodies[b], spacing, name);
    if (positions.empty()) {
      throw SettingsError(name + " holds no particle: it is smaller than the spacing of " + number_text(spacing, 4) +
                          " m");
    }
    check_fits_period(positions, spacing, periodic, name);
    std::erase_if(positions, [&](const Vec3& p) {
      const Vec3 inside = periodic.wrap(p);
      return is_cut_out(bodies[b], p) || has_near_image(walls, inside, wall_distance * spacing, periodic) ||
             has_near_image(fluid, inside, body_distance * spacing, periodic);
    });
    if (positions.empty()) {
      throw SettingsError(name + " has no particle left: it is cut out whole, or lies in other bodies or on a wall");
    }
    Vec3 centroid = Vec3::Zero();
    for (const Vec3& p : positions) centroid += p / static_cast<double>(positions.size());
    for (const Vec3& p : positions) {
      const Vec3 inside = periodic.wrap(p);
      points.push_back({inside, bodies[b].velocity + bodies[b].angular_velocity.cross(p - centroid), b});
      fluid.insert(inside);
    }
  }
  return points;
}

}  // namespace flowskin::sph
