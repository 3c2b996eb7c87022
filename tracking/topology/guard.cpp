#include "tracking/topology/guard.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/mesh_check.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kFoldedCosine = -0.93;  // neighbouring triangles with an inner angle below 21 degrees
constexpr double kLeastShape = 1e-3;     // doubled area over the longest squared side
// A few places of a large mesh may cut a crease or miss a bump finer than an edge, until fairing and remeshing reach
// them: no reason to give up the whole mesh. One place in so many is let pass.
constexpr int kOneIn = 500;

bool is_degenerate(const Triangle& triangle, const std::vector<Vec3>& positions) {
  double longest = 0;
  for (int corner = 0; corner < 3; ++corner) {
    longest = std::max(longest, (positions[triangle[corner]] - positions[triangle[(corner + 1) % 3]]).squaredNorm());
  }
  return !(doubled_area_vector(positions, triangle).norm() > kLeastShape * longest);
}

// Components that are large enough to count.
int count_large(const MeshComponents& components, double small_volume) {
  return static_cast<int>(std::count_if(components.volumes.begin(), components.volumes.end(),
                                        [&](double volume) { return std::abs(volume) >= small_volume; }));
}

void check_defects(int count, int tolerated, const std::string& what, std::vector<std::string>& reasons) {
  if (count > tolerated) reasons.push_back(std::to_string(count) + " " + what);
}

// The middles of the triangles must lie near the surface, too: a mesh whose vertices are all on f = 0 may still cut
// through the fluid where parts have merged.
int count_off_triangles(const MetaballField& field, const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles, double sagitta) {
  const ProjectionSettings projection = default_projection(field.settings());
  std::vector<char> off(triangles.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& [a, b, c] = triangles[t];
    const Vec3 middle = (positions[a] + positions[b] + positions[c]) / 3;
    SurfaceDistance distance = surface_distance(field, middle);
    if (distance.distance <= sagitta) continue;
    // |f| / |grad f| is too large where grad f nearly vanishes, as between two sheets: measure the way itself.
    Vec3 foot = middle;
    off[t] = !project_point(field, projection, foot, distance) || (foot - middle).norm() > sagitta;
  }
  return static_cast<int>(std::count(off.begin(), off.end(), 1));
}

void check_coverage(const SurfaceGeometry& fresh, const std::vector<Vec3>& positions,
                    const std::vector<Triangle>& triangles, const GuardSettings& settings,
                    std::vector<std::string>& reasons) {
  const MeshComponents components = mesh_components(fresh.positions, fresh.triangles);
  const ClosestPointTree tree(positions, triangles);
  std::vector<char> uncovered(fresh.positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < static_cast<int>(fresh.positions.size()); ++v) {
    const bool counts = std::abs(components.volumes[components.of_vertex[v]]) >= settings.small_volume;
    uncovered[v] = counts && tree.closest(fresh.positions[v], settings.reach).triangle < 0;
  }
  const auto count = std::count(uncovered.begin(), uncovered.end(), 1);
  if (count > std::ssize(fresh.positions) / kOneIn) {
    reasons.push_back(std::to_string(count) + " places of the surface are not covered by the mesh");
  }
}

}  // namespace

GuardSettings default_guard(double spacing, double edge_length, const FieldSettings& field) {
  GuardSettings settings;
  settings.tolerance = 1e-4 * field.radius;
  settings.longest_edge = 4 * edge_length;
  settings.reach = 1.25 * edge_length;
  settings.sagitta = 0.6 * edge_length;
  settings.small_volume = 4 * spacing * spacing * spacing;
  return settings;
}

std::vector<int> bad_triangles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const MeshTopology& topology, const std::vector<Vec3>& normals) {
  std::vector<int> bad;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    if (is_degenerate(triangles[t], positions) || is_inverted(triangles[t], positions, normals)) bad.push_back(t);
  }
  for (const auto& [first, second] : topology.edge_triangles) {
    if (second < 0) continue;
    const Vec3 a = doubled_area_vector(positions, triangles[first]);
    const Vec3 b = doubled_area_vector(positions, triangles[second]);
    if (a.dot(b) < kFoldedCosine * a.norm() * b.norm()) bad.insert(bad.end(), {first, second});
  }
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

MeshDefects find_defects(const MetaballField& field, const std::vector<Vec3>& positions,
                         const std::vector<Triangle>& triangles, const MeshTopology& topology,
                         const Projection& projection, const GuardSettings& settings) {
  MeshDefects defects;
  if (!(projection.max_distance <= settings.tolerance)) {
    defects.off_vertices = static_cast<int>(projection.failed.size());
  }
  defects.bad_triangles = static_cast<int>(bad_triangles(positions, triangles, topology, projection.normals).size());
  const std::vector<double> lengths = edge_lengths(topology, positions);
  defects.long_edges = static_cast<int>(
      std::count_if(lengths.begin(), lengths.end(), [&](double length) { return length > settings.longest_edge; }));
  defects.off_triangles = count_off_triangles(field, positions, triangles, settings.sagitta);
  return defects;
}

GuardVerdict inspect(const SurfaceGeometry& fresh, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const MeshDefects& defects, const MeshDefects& tolerated,
                     const GuardSettings& settings) {
  GuardVerdict verdict;
  const MeshComponents components = mesh_components(positions, triangles);
  const MeshComponents expected = mesh_components(fresh.positions, fresh.triangles);
  verdict.components = components.count;
  verdict.expected_components = expected.count;
  verdict.volume = mesh_volume(positions, triangles);
  verdict.expected_volume = mesh_volume(fresh.positions, fresh.triangles);

  const int large = count_large(components, settings.small_volume);
  const int expected_large = count_large(expected, settings.small_volume);
  if (large != expected_large) {
    verdict.reasons.push_back(std::to_string(large) + " parts instead of " + std::to_string(expected_large));
  }
  if (!(std::abs(verdict.volume - verdict.expected_volume) <= settings.volume_tolerance * verdict.expected_volume)) {
    const double permille = std::round(1000 * (verdict.volume / verdict.expected_volume - 1));
    verdict.reasons.push_back("volume off by " + std::to_string(static_cast<int>(permille)) + " per mille");
  }
  check_defects(defects.off_vertices, tolerated.off_vertices, "vertices off the surface", verdict.reasons);
  check_defects(defects.bad_triangles, tolerated.bad_triangles, "degenerate or folded triangles", verdict.reasons);
  check_defects(defects.long_edges, tolerated.long_edges, "overstretched edges", verdict.reasons);
  check_defects(defects.off_triangles, tolerated.off_triangles + static_cast<int>(triangles.size()) / kOneIn,
                "triangles off the surface", verdict.reasons);
  check_coverage(fresh, positions, triangles, settings, verdict.reasons);
  for (const std::string& problem : mesh_problems(positions, triangles)) verdict.reasons.push_back(problem);
  return verdict;
}

}  // namespace flowskin::tracking
