// Places of the material at other times stay with it, whatever happens to the mesh.
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/material/material.h"
#include "tracking/tracker.h"

namespace flowskin::tracking::layers_test {
namespace {

constexpr double kEdge = 0.75;

TrackerSettings settings() {
  TrackerSettings settings;
  settings.spacing = 1;
  settings.velocity = "hybrid";
  return settings;
}

TEST(Layers, VerticesKeepThePlacesOfTheMomentInWhichTheyBegan) {
  const std::vector<Vec3> start = test::ball_of_particles(4.2);
  const Vec3 spin(0.3, 0.2, 2), drift(1, -2, 0.5);
  Tracker tracker(settings(), test::rigidly_moved(start, spin, drift, 0));
  tracker.advance(test::rigidly_moved(start, spin, drift, 0.1));
  tracker.begin_layer();
  EXPECT_EQ(tracker.mesh().layers.at(0), tracker.mesh().positions);
  std::map<std::uint64_t, Vec3> places;
  for (std::size_t v = 0; v < tracker.mesh().ids.size(); ++v)
    places[tracker.mesh().ids[v]] = tracker.mesh().positions[v];
  int kept = 0, born = 0, changes = 0;
  for (int frame = 2; frame <= 12; ++frame) {
    Particles particles = test::rigidly_moved(start, spin, drift, 0.1 * frame);
    particles.layers = {test::rigidly_moved(start, spin, drift, 0.1).positions};
    tracker.advance(particles);
    changes += tracker.report().splits + tracker.report().collapses + tracker.report().regions;
    const SurfaceMesh& mesh = tracker.mesh();
    ASSERT_EQ(mesh.layers.at(0).size(), mesh.positions.size());
    double squares = 0;
    for (std::size_t v = 0; v < mesh.ids.size(); ++v) {
      const auto found = places.find(mesh.ids[v]);
      kept += found != places.end();
      born += found == places.end();
      const Vec3 still = test::rotation(spin * 0.1) *
                             (test::rotation(-spin * 0.1 * frame) * (mesh.positions[v] - drift * 0.1 * frame)) +
                         drift * 0.1;
      squares += (mesh.layers[0][v] - still).squaredNorm();
    }
    // What the midpoint rule turns too far: vertices slide along the surface, but their material stays where it is.
    EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.ids.size())), 0.02 * kEdge) << frame;
  }
  EXPECT_GT(kept, 1000);
  EXPECT_EQ(born > 0, changes > 0);
  tracker.drop_layer(0);
  EXPECT_TRUE(tracker.mesh().layers.empty());
}

TEST(Layers, OfNewSurfaceComeFromTheParticlesBeneath) {
  // A second ball appears beside the first, farther than old surface reaches: its layer can only be the particles'.
  std::vector<Vec3> start = test::ball_of_particles(3.2);
  Tracker tracker(settings(), test::particles_at(start));
  tracker.begin_layer();
  tracker.begin_layer();
  for (const Vec3& x : test::ball_of_particles(3.2, {9, 0, 0}, 5)) start.push_back(x);
  Particles particles = test::particles_at(start);
  particles.time = 0.1;
  const auto first = [](const Vec3& x) { return Vec3(x + Vec3(3 + 0.3 * x[1], 0, -0.2 * x[0])); };
  const auto second = [](const Vec3& x) { return Vec3(2 * x - Vec3(0, 0.1 * x[2], 1)); };
  particles.layers.resize(2);
  for (const Vec3& x : start) {
    particles.layers[0].push_back(first(x));
    particles.layers[1].push_back(second(x));
  }
  tracker.advance(particles);
  const SurfaceMesh& mesh = tracker.mesh();
  int checked = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v][0] < 5) continue;
    ++checked;
    EXPECT_LT((mesh.layers[0][v] - first(mesh.positions[v])).norm(), 2e-3);
    EXPECT_LT((mesh.layers[1][v] - second(mesh.positions[v])).norm(), 2e-3);
    EXPECT_LT((mesh.rest_positions[v] - mesh.positions[v]).norm(), 2e-3);
  }
  EXPECT_GT(checked, 100);
}

TEST(Layers, OfAWholeNewMeshAreInterpolatedOverTheOldOne) {
  const Particles particles = test::particles_at(test::ball_of_particles(4.2));
  const FieldSettings field_settings = default_field_settings(1);
  const MetaballField field(particles.positions, {}, field_settings);
  const SurfaceGeometry surface = extract_surface(field, kEdge);
  SurfaceMesh old_mesh;
  old_mesh.positions = old_mesh.rest_positions = surface.positions;
  old_mesh.triangles = surface.triangles;
  const auto place = [](const Vec3& x) { return Vec3(x[1] + 7, 2 * x[0], x[2] - x[0]); };
  old_mesh.layers.emplace_back();
  for (const Vec3& x : surface.positions) {
    old_mesh.layers[0].push_back(place(x));
    old_mesh.ids.push_back(old_mesh.next_id++);
  }
  std::vector<Vec3> normals;
  for (const Vec3& x : surface.positions) normals.push_back(x.normalized());
  const SurfaceMesh mesh = carry_material(old_mesh, surface, normals, field, particles, {kEdge, kEdge / 3, 5});
  ASSERT_EQ(mesh.layers.size(), 1U);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_LT((mesh.layers[0][v] - place(mesh.positions[v])).norm(), 1e-9);
}

TEST(Layers, SurviveASurfaceThatVanishesAndComesBack) {
  const std::vector<Vec3> start = test::ball_of_particles(3.2);
  Tracker tracker(settings(), test::particles_at(start));
  tracker.begin_layer();
  Particles none;
  none.time = 1;
  tracker.advance(none);
  EXPECT_EQ(tracker.mesh().layers.size(), 1U);
  Particles again = test::particles_at(start);
  again.time = 2;
  again.layers = {start};
  for (Vec3& x : again.layers[0]) x += Vec3(0, 4, 0);
  tracker.advance(again);
  ASSERT_EQ(tracker.mesh().layers.at(0).size(), tracker.mesh().positions.size());
  for (std::size_t v = 0; v < tracker.mesh().positions.size(); ++v)
    EXPECT_LT((tracker.mesh().layers[0][v] - tracker.mesh().positions[v] - Vec3(0, 4, 0)).norm(), 1e-6);
}

TEST(Layers, BadOnesAreRefused) {
  Particles particles = test::particles_at(test::ball_of_particles(3.2));
  Tracker tracker(settings(), particles);
  EXPECT_THROW(tracker.drop_layer(0), std::out_of_range);
  const auto message = [&] {
    try {
      tracker.advance(particles);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  particles.layers = {{Vec3::Zero()}};
  EXPECT_NE(message().find("a layer must have one entry per particle, but has 1 for"), std::string::npos) << message();
  particles.layers = {particles.positions};
  particles.layers[0][3].y() = std::nan("");
  EXPECT_NE(message().find("the particle with id 3 has a place in a layer that is not finite"), std::string::npos);
}

}  // namespace
}  // namespace flowskin::tracking::layers_test
