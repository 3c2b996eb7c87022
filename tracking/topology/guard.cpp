#include "tracking/topology/guard.h"

#include <algorithm>
#include <cmath>

#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kFoldedCosine = -0.5;  // neighbouring triangles with an inner angle below 60 degrees
constexpr double kLeastShape = 1e-3;    // doubled area over the longest squared side

bool is_degenerate(const Triangle& triangle, const std::vector<Vec3>& positions) {
  double longest = 0;
  for (int corner = 0; corner < 3; ++corner) {
    longest = std::max(longest, (positions[triangle[corner]] - positions[triangle[(corner + 1) % 3]]).squaredNorm());
  }
  return !(doubled_area_vector(positions, triangle).norm() > kLeastShape * longest);
}

std::string count_of(std::size_t count, const std::string& what) { return std::to_string(count) + " " + what; }

// Components that are large enough to count.
int count_large(const MeshComponents& components, double small_volume) {
  return static_cast<int>(std::count_if(components.volumes.begin(), components.volumes.end(),
                                        [&](double volume) { return std::abs(volume) >= small_volume; }));
}

void check_vertices(const Projection& projection, double tolerance, std::vector<std::string>& reasons) {
  if (!projection.failed.empty() && !(projection.max_distance <= tolerance)) {
    reasons.push_back(count_of(projection.failed.size(), "vertices off the surface"));
  }
}

void check_edges(const std::vector<Vec3>& positions, const MeshTopology& topology, double longest_edge,
                 std::vector<std::string>& reasons) {
  const std::vector<double> lengths = edge_lengths(topology, positions);
  const auto count =
      std::count_if(lengths.begin(), lengths.end(), [&](double length) { return length > longest_edge; });
  if (count > 0) reasons.push_back(count_of(static_cast<std::size_t>(count), "overstretched edges"));
}

// The middles of the triangles must lie near the surface, too: a mesh whose vertices are all on f = 0 may still cut
// through the fluid where parts have merged.
void check_triangle_middles(const MetaballField& field, const std::vector<Vec3>& positions,
                            const std::vector<Triangle>& triangles, double sagitta, std::vector<std::string>& reasons) {
  std::vector<char> off(triangles.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& [a, b, c] = triangles[t];
    const SurfaceDistance middle = surface_distance(field, (positions[a] + positions[b] + positions[c]) / 3);
    off[t] = !(middle.distance <= sagitta);
  }
  const auto count = std::count(off.begin(), off.end(), 1);
  if (count > 0) reasons.push_back(count_of(static_cast<std::size_t>(count), "triangles off the surface"));
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
  if (count > 0) {
    reasons.push_back(count_of(static_cast<std::size_t>(count), "places of the surface are not covered by the mesh"));
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

GuardVerdict inspect(const MetaballField& field, const SurfaceGeometry& fresh, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const MeshTopology& topology, const Projection& projection,
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
    const double percent = 100 * (verdict.volume / verdict.expected_volume - 1);
    verdict.reasons.push_back("volume off by " + std::to_string(percent) + " %");
  }
  check_vertices(projection, settings.tolerance, verdict.reasons);
  const std::size_t bad = bad_triangles(positions, triangles, topology, projection.normals).size();
  if (bad > 0) verdict.reasons.push_back(count_of(bad, "degenerate or folded triangles"));
  check_edges(positions, topology, settings.longest_edge, verdict.reasons);
  check_triangle_middles(field, positions, triangles, settings.sagitta, verdict.reasons);
  check_coverage(fresh, positions, triangles, settings, verdict.reasons);
  return verdict;
}

}  // namespace flowskin::tracking
