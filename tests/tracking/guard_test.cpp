// The guard must see each kind of fault and nothing else; material must survive a change of the mesh.
#include "tracking/topology/guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/topology/material.h"
#include "tracking/topology/small_parts.h"

namespace flowskin::tracking {
namespace {

using test::ball_of_particles;

constexpr double kEdge = 0.8;
const FieldSettings kField = default_field_settings(1);

// What the guard says about a mesh in a field; the vertices are projected first, unless told otherwise.
std::string verdict(const MetaballField& field, SurfaceGeometry mesh, bool project = true) {
  const GuardSettings settings = default_guard(1, kEdge, kField);
  const MeshTopology topology = build_topology(static_cast<int>(mesh.positions.size()), mesh.triangles);
  Projection projection = project_to_surface(field, default_projection(kField), mesh.positions);
  if (!project) projection.failed.clear();
  const MeshDefects defects = find_defects(field, mesh.positions, mesh.triangles, topology, projection, settings);
  const SurfaceGeometry fresh = extract_raw_surface(field, kEdge);
  return test::joined(inspect(fresh, mesh.positions, mesh.triangles, defects, {}, settings).reasons);
}

void expect_reason(const std::string& reasons, const std::string& words) {
  EXPECT_NE(reasons.find(words), std::string::npos) << "expected: " << words << "\nfound: " << reasons;
}

std::vector<Vec3> two_balls(double distance) {
  std::vector<Vec3> points = ball_of_particles(3.2);
  for (const Vec3& x : ball_of_particles(3.2, {distance, 0, 0}, 5)) points.push_back(x);
  return points;
}

TEST(Guard, IsContentWithAFreshMesh) {
  for (const double radius : {2.3, 4.2, 6.3}) {
    const MetaballField field(ball_of_particles(radius), {}, kField);
    EXPECT_EQ(verdict(field, extract_surface(field, kEdge)), "");
  }
  const MetaballField field(two_balls(12), {}, kField);
  EXPECT_EQ(verdict(field, extract_surface(field, kEdge)), "");
}

TEST(Guard, SeesAMissingPart) {
  const MetaballField field(two_balls(12), {}, kField);
  const SurfaceGeometry one = extract_surface(MetaballField(ball_of_particles(3.2), {}, kField), kEdge);
  const std::string reasons = verdict(field, one);
  expect_reason(reasons, "1 parts instead of 2");
  expect_reason(reasons, "volume off by -");
  expect_reason(reasons, "places of the surface are not covered");
}

TEST(Guard, DoesNotCountParts_SmallerThanItsLimit) {
  // A clump that just breaks through the threshold beside the ball.
  std::vector<Vec3> points = ball_of_particles(4.2);
  for (int i = 0; i < 6; ++i) points.emplace_back(12 + 0.2 * (i % 2), 0.2 * (i / 2), 0);
  const MetaballField field(points, {}, kField);
  const SurfaceGeometry raw = extract_raw_surface(field, kEdge);
  ASSERT_EQ(mesh_components(raw.positions, raw.triangles).count, 2);
  const SurfaceGeometry ball = extract_surface(MetaballField(ball_of_particles(4.2), {}, kField), kEdge);
  EXPECT_EQ(verdict(field, ball), "");
}

TEST(Guard, SeesPartsThatHaveMerged) {
  const SurfaceGeometry apart = extract_surface(MetaballField(two_balls(8.2), {}, kField), kEdge);
  ASSERT_EQ(mesh_components(apart.positions, apart.triangles).count, 2);
  const MetaballField merged(two_balls(6.5), {}, kField);
  SurfaceGeometry mesh = apart;
  for (Vec3& x : mesh.positions) x[0] -= x[0] > 4.1 ? 1.7 : 0;  // the second ball has come nearer
  expect_reason(verdict(merged, mesh), "2 parts instead of 1");
}

TEST(Guard, SeesAFold) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  SurfaceGeometry mesh = extract_surface(field, kEdge);
  const int neighbor = build_topology(static_cast<int>(mesh.positions.size()), mesh.triangles).ring(0)[0].vertex;
  mesh.positions[0] += 1.7 * (mesh.positions[neighbor] - mesh.positions[0]);
  expect_reason(verdict(field, mesh), "degenerate or folded triangles");
}

TEST(Guard, SeesATriangleWithoutArea) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  SurfaceGeometry mesh = extract_surface(field, kEdge);
  const Triangle triangle = mesh.triangles[17];
  mesh.positions[triangle[0]] = mesh.positions[triangle[1]];
  expect_reason(verdict(field, mesh), "degenerate or folded triangles");
}

TEST(Guard, SeesAMeshThatIsInsideOut) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  expect_reason(verdict(field, test::flipped(extract_surface(field, kEdge))), "degenerate or folded triangles");
}

TEST(Guard, SeesVerticesOffTheSurface) {
  const MetaballField field(ball_of_particles(4.2), {}, kField);
  SurfaceGeometry mesh = extract_surface(field, kEdge);
  mesh.positions[3] *= 4;  // where the field is silent
  expect_reason(verdict(field, mesh), "1 vertices off the surface");
}

TEST(Guard, SeesOverstretchedEdgesAndTrianglesThatCutThroughTheFluid) {
  const MetaballField field(ball_of_particles(6.3), {}, kField);
  const SurfaceGeometry coarse = extract_surface(field, 5 * kEdge);
  const std::string reasons = verdict(field, coarse);
  expect_reason(reasons, "overstretched edges");
  expect_reason(reasons, "triangles off the surface");
  expect_reason(reasons, "volume off by -");
}

// A ball and a drop beside it, as a mesh with all its attributes.
SurfaceMesh ball_and_drop() {
  SurfaceGeometry geometry = extract_surface(MetaballField(ball_of_particles(3.2), {}, kField), kEdge);
  SurfaceGeometry drop = test::tetrahedron();
  for (Vec3& x : drop.positions) x += Vec3(9, 0, 0);
  geometry = test::both(geometry, drop);
  SurfaceMesh mesh;
  mesh.positions = mesh.rest_positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.velocities.resize(mesh.positions.size(), Vec3::Zero());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.ids.push_back(mesh.next_id++);
  return mesh;
}

TEST(SmallParts, GoOnlyWhereTheyAreSpoilt) {
  SurfaceMesh mesh = ball_and_drop();
  const int vertices = static_cast<int>(mesh.positions.size());
  EXPECT_FALSE(drop_spoilt_parts({}, {}, 4, mesh));
  EXPECT_EQ(static_cast<int>(mesh.positions.size()), vertices);

  Projection of_ball, of_drop;
  of_ball.failed = {3};
  of_drop.failed = {vertices - 1};
  EXPECT_FALSE(drop_spoilt_parts(of_ball, {5}, 4, mesh));  // large: left to the guard
  EXPECT_TRUE(drop_spoilt_parts(of_drop, {}, 4, mesh));
  EXPECT_EQ(static_cast<int>(mesh.positions.size()), vertices - 4);
  EXPECT_EQ(test::joined(mesh_problems(mesh)), "");

  mesh = ball_and_drop();
  EXPECT_TRUE(drop_spoilt_parts({}, {static_cast<int>(mesh.triangles.size()) - 1}, 4, mesh));
  mesh = ball_and_drop();
  for (std::size_t t = mesh.triangles.size() - 4; t < mesh.triangles.size(); ++t) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  EXPECT_TRUE(drop_spoilt_parts({}, {}, 4, mesh));
  EXPECT_EQ(test::joined(mesh_problems(mesh)), "");
}

TEST(Guard, ToleratesWhatItIsTold) {
  const MetaballField field(ball_of_particles(3.2), {}, kField);
  const SurfaceGeometry mesh = extract_surface(field, kEdge);
  const MeshDefects defects{1, 2, 3, 4};
  const GuardSettings settings = default_guard(1, kEdge, kField);
  EXPECT_TRUE(inspect(mesh, mesh.positions, mesh.triangles, defects, {1, 2, 3, 4}, settings).reasons.empty());
  EXPECT_EQ(inspect(mesh, mesh.positions, mesh.triangles, defects, {0, 2, 3, 3}, settings).reasons.size(), 2U);
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

TEST(Material, BeneathDoesNotMixBodiesThatHaveMet) {
  // Two blocks side by side that came from far apart: the surface above each keeps to its own.
  Particles particles = test::particles_at(
      test::lattice(1.0, 4, 0.05, 2, [](const Vec3& x) { return std::abs(x[1]) < 3 && std::abs(x[2]) < 3; }));
  for (Vec3& rest : particles.rest_positions) rest[0] += rest[0] > 0.5 ? 100 : -100;
  const MetaballField field(particles.positions, {}, kField);
  for (const double x : {-2.0, -0.5, 0.2, 0.9, 2.0}) {
    const Vec3 place(x, 2.5, 0.1);
    const double shift = rest_position_at(field, particles, place)[0] - x;
    EXPECT_NEAR(std::abs(shift), 100, 0.5);
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
  return project_to_surface(field, default_projection(kField), positions).normals;
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

}  // namespace
}  // namespace flowskin::tracking
