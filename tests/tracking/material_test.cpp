// Material must survive a change of the mesh.
#include "tracking/material/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/quantile.h"
#include "tests/tracking/field_test_bodies.h"
#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/extract_surface.h"

namespace flowskin::tracking::material_test {
namespace {

using test::ball_of_particles;

constexpr double kEdge = 0.8;
const FieldSettings kField = default_field_settings(1);

std::vector<Vec3> two_balls(double distance) {
  std::vector<Vec3> points = ball_of_particles(3.2);
  for (const Vec3& x : ball_of_particles(3.2, {distance, 0, 0}, 5)) points.push_back(x);
  return points;
}

// Particles whose material has been moved from its rest position by a smooth deformation.
Vec3 rest_of(const Vec3& x, double bend) { return x + Vec3(3 + 0.3 * x[1], bend * x[0] * x[0], -0.2 * x[0]); }

Particles deformed(const std::vector<Vec3>& positions, double bend) {
  Particles particles = test::particles_at(positions);
  for (Vec3& rest : particles.rest_positions) rest = rest_of(rest, bend);
  return particles;
}

TEST(Material, BeneathIsExactForLinearDisplacement) {
  const Particles particles = deformed(ball_of_particles(4.2), 0);
  const MetaballField field(particles.positions, {}, kField);
  for (const Vec3& x : extract_surface(field, kEdge).positions) {
    EXPECT_LT((rest_position_at(field, particles, x) - rest_of(x, 0)).norm(), 1e-4);
  }
}

TEST(Material, BeneathIsThePlaceItselfAtRest) {
  const Particles particles = test::particles_at(ball_of_particles(3.2));
  const MetaballField field(particles.positions, {}, kField);
  for (const Vec3& x : extract_surface(field, kEdge).positions) EXPECT_EQ(rest_position_at(field, particles, x), x);
}

TEST(Material, BeneathWorksWithFewParticles) {
  Particles particles = test::particles_at({{0, 0, 0}});
  particles.rest_positions[0] = {5, 0, 0};
  EXPECT_LT(
      (rest_position_at(MetaballField(particles.positions, {}, kField), particles, {1, 0, 0}) - Vec3(6, 0, 0)).norm(),
      1e-5);
  particles = test::particles_at({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});  // on a line
  for (Vec3& rest : particles.rest_positions) rest += Vec3(0, 7, 0);
  EXPECT_LT(
      (rest_position_at(MetaballField(particles.positions, {}, kField), particles, {1, 1, 0}) - Vec3(1, 8, 0)).norm(),
      1e-5);
}

// Two blocks side by side whose material was shifted along x: `shift` to the left of 0.5 and the opposite beyond.
Particles blocks_that_met(double shift) {
  Particles particles = test::particles_at(
      test::lattice(1.0, 4, 0.05, 2, [](const Vec3& x) { return std::abs(x[1]) < 3 && std::abs(x[2]) < 3; }));
  for (Vec3& rest : particles.rest_positions) rest[0] += rest[0] > 0.5 ? shift : -shift;
  return particles;
}

// From far apart, where the rest positions of neighbours tell; and from near, where only the jump of the displacements
// does. Where that is less than about three spacings it is taken for a stretch.
TEST(Material, BeneathDoesNotMixBodiesThatHaveMet) {
  for (const double shift : {100.0, 1.5}) {
    const Particles particles = blocks_that_met(shift);
    const MetaballField field(particles.positions, {}, kField);
    for (const double x : {-2.0, -0.5, 0.2, 0.9, 2.0}) {
      const double found = rest_position_at(field, particles, Vec3(x, 2.5, 0.1))[0] - x;
      EXPECT_NEAR(found, x > 0.5 ? shift : -shift, 0.03 * shift) << "at " << x;
    }
  }
}

// Where the displacement varies but does not jump, nothing is torn.
TEST(Material, BeneathFollowsAStretchThatIsNoJump) {
  Particles particles = test::particles_at(ball_of_particles(4.2));
  for (Vec3& rest : particles.rest_positions) rest[0] += 0.15 * std::sin(rest[0]);
  const MetaballField field(particles.positions, {}, kField);
  for (const double x : {-2.0, -0.7, 0.4, 1.6}) {
    const Vec3 place(x, 0.3, 3.4);
    EXPECT_NEAR(rest_position_at(field, particles, place)[0] - x, 0.15 * std::sin(x), 0.06);
  }
}

SurfaceMesh with_material(const SurfaceGeometry& geometry, double bend) {
  SurfaceMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  for (const Vec3& x : mesh.positions) {
    mesh.rest_positions.push_back(rest_of(x, bend));
    mesh.velocities.push_back(Vec3::Zero());
    mesh.ids.push_back(mesh.next_id++);
  }
  return mesh;
}

const MaterialSettings kMaterial{kEdge, kEdge / 3};

std::vector<Vec3> normals_of(const MetaballField& field, const SurfaceGeometry& surface) {
  std::vector<Vec3> positions = surface.positions;
  return project_to_surface(field, default_projection(kField.scale()), positions).normals;
}

TEST(Material, SurvivesAReextraction) {
  const Particles particles = deformed(ball_of_particles(6.3), 0.05);
  const MetaballField field(particles.positions, {}, kField);
  // The old mesh is another one of the same surface, its material off from the particles' by a drift of one spacing:
  // the new mesh must follow the old mesh, not the particles.
  SurfaceMesh old_mesh = with_material(extract_surface(field, 1.07 * kEdge), 0.05);
  const Vec3 drift(0, 0, 1);
  for (Vec3& rest : old_mesh.rest_positions) rest += drift;
  const SurfaceGeometry fresh = extract_surface(field, kEdge);
  const SurfaceMesh mesh = carry_material(old_mesh, fresh, normals_of(field, fresh), field, particles, kMaterial);
  double largest = 0, squares = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double error = (mesh.rest_positions[v] - rest_of(mesh.positions[v], 0.05) - drift).norm();
    largest = std::max(largest, error);
    squares += error * error;
  }
  // Interpolation over a chord: the sagitta, edge^2 / (8 times the radius of curvature), which is 0.02 edges on the
  // mean and several times as much where the body of particles has bumps and the edges are longest.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.positions.size())), 0.03 * kEdge);
  EXPECT_LT(largest, 0.15 * kEdge);
}

TEST(Material, OfSurfaceThatIsNewComesFromTheParticles) {
  const Particles particles = deformed(two_balls(12), 0.05);
  const MetaballField field(particles.positions, {}, kField);
  // The old mesh knows the first ball only, and its material has drifted.
  SurfaceMesh old_mesh = with_material(extract_surface(MetaballField(ball_of_particles(3.2), {}, kField), kEdge), 0.05);
  for (Vec3& rest : old_mesh.rest_positions) rest += Vec3(0, 50, 0);
  const SurfaceGeometry fresh = extract_surface(field, kEdge);
  const SurfaceMesh mesh = carry_material(old_mesh, fresh, normals_of(field, fresh), field, particles, kMaterial);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 drift(0, mesh.positions[v][0] < 6 ? 50 : 0, 0);
    EXPECT_LT((mesh.rest_positions[v] - drift - rest_of(mesh.positions[v], 0.05)).norm(), 0.2);
  }
}

TEST(Material, IdsStayWithVerticesThatStay) {
  const Particles particles = test::particles_at(ball_of_particles(4.2));
  const MetaballField field(particles.positions, {}, kField);
  const SurfaceGeometry fresh = extract_surface(field, kEdge);
  const std::vector<Vec3> normals = normals_of(field, fresh);
  const SurfaceMesh old_mesh = with_material(fresh, 0);
  const SurfaceMesh same = carry_material(old_mesh, fresh, normals, field, particles, kMaterial);
  EXPECT_EQ(same.ids, old_mesh.ids);
  EXPECT_EQ(same.next_id, old_mesh.next_id);

  const SurfaceGeometry other = extract_surface(field, 1.3 * kEdge);
  const SurfaceMesh changed = carry_material(old_mesh, other, normals_of(field, other), field, particles, kMaterial);
  const std::set<std::uint64_t> ids(changed.ids.begin(), changed.ids.end());
  EXPECT_EQ(ids.size(), changed.ids.size());
  int kept = 0;
  for (std::size_t v = 0; v < changed.ids.size(); ++v) {
    EXPECT_LT(changed.ids[v], changed.next_id);
    if (changed.ids[v] >= old_mesh.next_id) continue;
    ++kept;
    EXPECT_LE((changed.positions[v] - old_mesh.positions[changed.ids[v]]).norm(), kMaterial.same_vertex);
  }
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, static_cast<int>(changed.ids.size()));
}

// A sheet thinner than the reach has moved along its normal, so that its lower side is where its upper side was.
TEST(Material, IdsDoNotGoFromOneSideOfAThinSheetToTheOther) {
  constexpr int kSide = 6;
  SurfaceGeometry sheet;
  std::vector<Vec3> normals;
  for (const double z : {0.0, -0.2}) {
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        sheet.positions.emplace_back(kEdge * i, kEdge * j, z);
        normals.emplace_back(0, 0, z < 0 ? -1 : 1);
      }
    }
  }
  const int lower = (kSide + 1) * (kSide + 1);
  test::add_grid_triangles(0, kSide, sheet.triangles);
  test::add_grid_triangles(lower, kSide, sheet.triangles);
  for (auto t = sheet.triangles.size() / 2; t < sheet.triangles.size(); ++t)
    std::swap(sheet.triangles[t][1], sheet.triangles[t][2]);
  const SurfaceMesh old_mesh = with_material(sheet, 0);
  const Particles particles = test::particles_at(ball_of_particles(2.3));
  const MetaballField field(particles.positions, {}, kField);
  SurfaceGeometry moved = sheet;
  for (Vec3& x : moved.positions) x.z() += 0.15;
  const SurfaceMesh mesh = carry_material(old_mesh, moved, normals, field, particles, kMaterial);
  EXPECT_EQ(mesh.ids, old_mesh.ids);
}

// Smooth motion scatters nothing; noise of the rest positions comes back, a little larger by that of the neighbours.
TEST(MaterialScatter, IsTheNoiseOfTheRestPositions) {
  Particles particles = test::particles_at(ball_of_particles(4.2));
  Mat3 gradient;
  gradient << 0.3, 0.1, 0, -0.2, 0.4, 0.1, 0, 0.3, -0.1;
  for (Vec3& rest : particles.rest_positions) rest = gradient * rest + Vec3(5, -2, 1);
  const MetaballField field = field_of(particles, kField);
  const std::vector<double> smooth = material_scatter(field, particles);
  EXPECT_EQ(smooth.size(), particles.ids.size());
  EXPECT_LT(*std::max_element(smooth.begin(), smooth.end()), 1e-4);
  EXPECT_LE(material_scatter(field, particles, 50).size(), 100U);

  test::Random random(9);
  std::vector<double> lengths;
  for (Vec3& rest : particles.rest_positions) {
    const Vec3 noise = 0.5 * random.vector();
    lengths.push_back(noise.norm());
    rest += noise;
  }
  const double noise = quantile(lengths, 0.5), scatter = quantile(material_scatter(field, particles), 0.5);
  EXPECT_GT(scatter, noise);
  EXPECT_LT(scatter, 1.3 * noise);
}

}  // namespace
}  // namespace flowskin::tracking::material_test
