// Whatever a vertex carries survives all that happens to vertices. The tests name no attribute: one that is added to
// the list is tested, too.
#include "tracking/mesh/vertex_attributes.h"

#include <gtest/gtest.h>

#include <string>

#include "common/state_archive.h"
#include "tests/tracking/field_test_bodies.h"
#include "tests/tracking/mesh_test_shapes.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/material/material.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/keep_vertices.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/tracker.h"

namespace flowskin::tracking {
namespace {

const FieldSettings kField = default_field_settings(1);

/// A vector that depends linearly on the place, differently for each attribute.
Vec3 linear(int attribute, const Vec3& x) { return x + Vec3(0.1 * x[1] + attribute, 0.05 * x[2], 2.0 * attribute); }

/// A mesh whose attributes are known functions of the place; ids count.
SurfaceMesh labelled(const SurfaceGeometry& geometry) {
  SurfaceMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.layers.resize(2);
  resize_attributes(mesh.positions.size(), mesh);
  int attribute = 0;
  for_each_attribute(mesh, [&](Carried, std::string_view, auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    ++attribute;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if constexpr (std::is_integral_v<Value>)
        values[v] = mesh.next_id++;
      else
        values[v] = linear(attribute, mesh.positions[v]);
    }
  });
  return mesh;
}

/// Every attribute that interpolates is the function of the place again, within the tolerance; ids are each once.
void expect_labels(const SurfaceMesh& mesh, double tolerance, bool with_motion) {
  int attribute = 0;
  for_each_attribute(mesh, [&](Carried how, std::string_view name, const auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    ++attribute;
    ASSERT_EQ(values.size(), mesh.positions.size()) << name;
    if constexpr (!std::is_integral_v<Value>) {
      if (how == Carried::motion && !with_motion) return;
      for (std::size_t v = 0; v < values.size(); ++v)
        EXPECT_LE((values[v] - linear(attribute, mesh.positions[v])).norm(), tolerance) << name << " of vertex " << v;
    }
  });
  EXPECT_EQ(test::joined(mesh_problems(mesh)), "");
}

SurfaceGeometry ball_surface() { return extract_surface(MetaballField(test::ball_of_particles(3.2), {}, kField), 0.8); }

TEST(VertexAttributes, SplitsGiveTheMiddle) {
  SurfaceMesh mesh = labelled(ball_surface());
  const std::uint64_t first_new = mesh.next_id;
  const Triangle triangle = mesh.triangles[7];
  EditableMesh editable(mesh.positions, mesh.triangles);
  ASSERT_GE(editable.split(triangle[0], triangle[1]), 0);
  add_middle_attributes(triangle[0], triangle[1], 100, mesh);
  expect_labels(mesh, 1e-12, true);
  EXPECT_EQ(mesh.ids.back(), first_new);
}

TEST(VertexAttributes, AcrossATearTheMaterialOfOneEndIsTaken) {
  SurfaceMesh mesh = labelled(ball_surface());
  const Triangle triangle = mesh.triangles[7];
  add_middle_attributes(triangle[0], triangle[1], 0, mesh);
  for_each_material(mesh, [&](const auto& places) { EXPECT_EQ(places.back(), places[triangle[0]]); });
}

TEST(VertexAttributes, CollapsesDropTheRightOnes) {
  SurfaceMesh mesh = labelled(ball_surface());
  const std::size_t before = mesh.positions.size();
  EditableMesh editable(mesh.positions, mesh.triangles);
  int collapsed = 0;
  for (int t = 0; t < 200 && collapsed < 5; ++t) {
    const Triangle triangle = mesh.triangles[t];
    if (triangle[0] >= 0 && editable.collapse(triangle[0], triangle[1], 3)) ++collapsed;
  }
  ASSERT_EQ(collapsed, 5);
  keep_attributes(editable.compact(), mesh);
  EXPECT_EQ(mesh.positions.size(), before - 5);
  expect_labels(mesh, 0, true);
}

TEST(VertexAttributes, FreshSurfaceGetsThemFromTheOldOne) {
  const SurfaceGeometry geometry = ball_surface();
  const SurfaceMesh old = labelled(geometry);
  const Particles particles = test::particles_at(test::ball_of_particles(3.2));
  const MetaballField field(particles.positions, {}, kField);
  SurfaceGeometry fresh = geometry;
  for (Vec3& x : fresh.positions) x += Vec3(1e-9, -1e-9, 0);
  const SurfaceMesh mesh = carry_material(old, fresh, vertex_normals(fresh.positions, fresh.triangles), field,
                                          particles, {.reach = 1, .same_vertex = 0.1, .far_reach = 1});
  expect_labels(mesh, 1e-6, false);
  EXPECT_EQ(mesh.ids, old.ids);
}

TEST(VertexAttributes, ArchivesGiveThemBack) {
  SurfaceMesh mesh = labelled(ball_surface());
  std::string bytes;
  StateWriter writer([&bytes](std::string_view more) { bytes += more; });
  visit_state(writer, mesh);
  writer.flush();
  SurfaceMesh again;
  StateReader reader(bytes);
  visit_state(reader, again);
  EXPECT_EQ(reader.bytes_left(), 0U);
  EXPECT_EQ(again.positions, mesh.positions);
  EXPECT_EQ(again.triangles, mesh.triangles);
  EXPECT_EQ(again.next_id, mesh.next_id);
  expect_labels(again, 0, true);
  EXPECT_EQ(again.layers.size(), mesh.layers.size());
}

}  // namespace
}  // namespace flowskin::tracking
