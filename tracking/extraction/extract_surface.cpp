#include "tracking/extraction/extract_surface.h"

#include <algorithm>
#include <cmath>

#include "tracking/advection/projection.h"
#include "tracking/extraction/improvement_limits.h"
#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/edges_by_length.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

using namespace improvement;

constexpr int kCollapsePasses = 4;
constexpr int kFlipPasses = 3;
constexpr double kLargestVolumeChange = 0.05;

MeshAdjacency topology_of(const SurfaceGeometry& surface) {
  return build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles);
}

// Collapses edges below the limit, the shortest first. Returns how many.
int collapse_short_edges(double shortest, double longest, SurfaceGeometry& surface) {
  const MeshAdjacency topology = topology_of(surface);
  const std::vector<int> order = edges_by_length(topology, surface.positions, EdgeOrder::shortest_first,
                                                 [&](int, double length) { return length < shortest; });
  const double volume = kLargestCollapse * longest * longest * longest;
  EditableMesh mesh(surface.positions, surface.triangles);
  int count = 0;
  for (int e : order) {
    const auto& [low, high] = topology.edges[e];
    if (mesh.collapse(low, high, longest, volume) || mesh.collapse(high, low, longest, volume)) ++count;
  }
  mesh.compact();
  return count;
}

void flip_towards_delaunay(SurfaceGeometry& surface) {
  for (int pass = 0; pass < kFlipPasses; ++pass) {
    const MeshAdjacency topology = topology_of(surface);
    EditableMesh mesh(surface.positions, surface.triangles);
    int count = 0;
    for (const auto& [a, b] : topology.edges) {
      if (mesh.wants_flip(a, b) && mesh.flip(a, b)) ++count;
    }
    if (count == 0) return;
  }
}

SurfaceGeometry improve_part(const ImplicitField& field, double edge_length, SurfaceGeometry surface) {
  const ProjectionSettings projection = default_projection(field.scale());
  for (int pass = 0; pass < kCollapsePasses; ++pass) {
    if (collapse_short_edges(kShortEdge * edge_length, kLongEdge * edge_length, surface) == 0) break;
  }
  for (int round = 0; round < kRounds; ++round) {
    flip_towards_delaunay(surface);
    std::vector<Vec3> normals = project_to_surface(field, projection, surface.positions).normals;
    relax(field, projection, topology_of(surface), surface.triangles, kRelaxationsPerRound, {}, surface.positions,
          normals, Ridges::kept);
    if (round + 1 < kRounds) collapse_short_edges(kShortEdge * edge_length, kLongEdge * edge_length, surface);
  }
  return surface;
}

// The components as surfaces of their own, vertices and triangles in their old order.
std::vector<SurfaceGeometry> split(const SurfaceGeometry& surface, const MeshComponents& components) {
  std::vector<SurfaceGeometry> parts(components.count);
  std::vector<int> number(surface.positions.size(), -1);
  for (std::size_t vertex = 0; vertex < surface.positions.size(); ++vertex) {
    if (components.of_vertex[vertex] < 0) continue;
    SurfaceGeometry& part = parts[components.of_vertex[vertex]];
    number[vertex] = static_cast<int>(part.positions.size());
    part.positions.push_back(surface.positions[vertex]);
  }
  for (const Triangle& triangle : surface.triangles) {
    parts[components.of_vertex[triangle[0]]].triangles.push_back(
        {number[triangle[0]], number[triangle[1]], number[triangle[2]]});
  }
  return parts;
}

void append(const SurfaceGeometry& part, SurfaceGeometry& whole) {
  const int first = static_cast<int>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
  for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

SurfaceGeometry extract_raw_surface(const ImplicitField& field, double edge_length) {
  const std::shared_ptr<const SparseGrid> grid = field.on_grid(edge_length);
  return march(*grid, [&](const Vec3& x) { return field.value(x); });
}

SurfaceGeometry improve_surface(const ImplicitField& field, double edge_length, const SurfaceGeometry& surface) {
  const MeshComponents components = mesh_components(surface.positions, surface.triangles);
  SurfaceGeometry result;
  for (const SurfaceGeometry& part : split(surface, components)) {
    SurfaceGeometry improved = improve_part(field, edge_length, part);
    const double volume = mesh_volume(part.positions, part.triangles);
    const double change = std::abs(mesh_volume(improved.positions, improved.triangles) - volume);
    // A part hardly larger than a triangle loses too much of its shape: it stays as marching cubes made it.
    append(change <= kLargestVolumeChange * std::abs(volume) ? improved : part, result);
  }
  project_to_surface(field, default_projection(field.scale()), result.positions);
  return result;
}

SurfaceGeometry extract_surface(const ImplicitField& field, double edge_length) {
  return improve_surface(field, edge_length, extract_raw_surface(field, edge_length));
}

}  // namespace flowskin::tracking
