#include "tracking/remeshing/remesh.h"

#include <algorithm>
#include <utility>

#include "tracking/mesh/editable_mesh.h"

namespace flowskin::tracking {
namespace {

using Edge = std::array<int, 2>;

MeshTopology topology_of(const SurfaceMesh& mesh) {
  return build_topology(static_cast<int>(mesh.positions.size()), mesh.triangles);
}

// Edges whose length fulfils a condition, in the order of their length (ascending or descending), then of their index:
// the outcome does not depend on chance.
template <class Condition>
std::vector<Edge> edges_by_length(const SurfaceMesh& mesh, Condition condition, bool longest_first) {
  const MeshTopology topology = topology_of(mesh);
  const std::vector<double> lengths = edge_lengths(topology, mesh.positions);
  std::vector<int> order;
  for (int e = 0; e < static_cast<int>(lengths.size()); ++e) {
    if (condition(lengths[e])) order.push_back(e);
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    if (lengths[a] != lengths[b]) return longest_first ? lengths[a] > lengths[b] : lengths[a] < lengths[b];
    return a < b;
  });
  std::vector<Edge> edges;
  for (int e : order) edges.push_back(topology.edges[e]);
  return edges;
}

int split_long_edges(const MetaballField& field, double longest, SurfaceMesh& mesh) {
  const auto edges = edges_by_length(
      mesh, [&](double length) { return length > longest; }, true);
  if (edges.empty()) return 0;
  const std::size_t old_count = mesh.positions.size();
  EditableMesh editable(mesh.positions, mesh.triangles);
  for (const auto& [a, b] : edges) {
    if (editable.split(a, b) < 0) continue;
    mesh.rest_positions.push_back((mesh.rest_positions[a] + mesh.rest_positions[b]) / 2);
    mesh.velocities.push_back((mesh.velocities[a] + mesh.velocities[b]) / 2);
    mesh.ids.push_back(mesh.next_id++);
  }
  std::vector<Vec3> born(mesh.positions.begin() + static_cast<std::ptrdiff_t>(old_count), mesh.positions.end());
  project_to_surface(field, default_projection(field.settings()), born);
  std::copy(born.begin(), born.end(), mesh.positions.begin() + static_cast<std::ptrdiff_t>(old_count));
  return static_cast<int>(born.size());
}

// The attributes of the vertices that remain, in their new order.
template <class T>
void renumber(const std::vector<int>& number, std::size_t count, std::vector<T>& values) {
  for (std::size_t vertex = 0; vertex < number.size(); ++vertex) {
    if (number[vertex] >= 0) values[static_cast<std::size_t>(number[vertex])] = values[vertex];
  }
  values.resize(count);
}

// Drops the removed vertices with all their attributes.
void compact(EditableMesh& editable, SurfaceMesh& mesh) {
  const std::vector<int> number = editable.compact();
  renumber(number, mesh.positions.size(), mesh.rest_positions);
  renumber(number, mesh.positions.size(), mesh.velocities);
  renumber(number, mesh.positions.size(), mesh.ids);
}

int collapse_short_edges(double shortest, double longest, SurfaceMesh& mesh) {
  const auto edges = edges_by_length(
      mesh, [&](double length) { return length < shortest; }, false);
  if (edges.empty()) return 0;
  EditableMesh editable(mesh.positions, mesh.triangles);
  int count = 0;
  for (const auto& [low, high] : edges) {
    // The older vertex is the better witness of its material.
    const bool low_is_older = mesh.ids[low] < mesh.ids[high];
    const int older = low_is_older ? low : high, younger = low_is_older ? high : low;
    count += editable.collapse(older, younger, longest) || editable.collapse(younger, older, longest);
  }
  compact(editable, mesh);
  return count;
}

int flip_bad_edges(double slack, SurfaceMesh& mesh) {
  const MeshTopology topology = topology_of(mesh);
  EditableMesh editable(mesh.positions, mesh.triangles);
  int count = 0;
  for (const auto& [a, b] : topology.edges) count += editable.wants_flip(a, b, slack) && editable.flip(a, b);
  return count;
}

}  // namespace

RemeshReport remesh(const MetaballField& field, const RemeshSettings& settings, SurfaceMesh& mesh) {
  RemeshReport report;
  const double longest = settings.longest * settings.edge_length;
  report.splits = split_long_edges(field, longest, mesh);
  report.collapses = collapse_short_edges(settings.shortest * settings.edge_length, longest, mesh);
  report.flips = flip_bad_edges(settings.delaunay_slack, mesh);
  return report;
}

int collapse_triangles(const std::vector<int>& triangles, const std::vector<Vec3>& normals, double longest,
                       SurfaceMesh& mesh) {
  const std::vector<Triangle> before = mesh.triangles;
  EditableMesh editable(mesh.positions, mesh.triangles);
  int count = 0;
  for (int t : triangles) {
    std::array<Edge, 3> edges;
    for (std::size_t corner = 0; corner < 3; ++corner) edges[corner] = {before[t][corner], before[t][(corner + 1) % 3]};
    const auto length = [&](const Edge& e) { return (mesh.positions[e[0]] - mesh.positions[e[1]]).norm(); };
    std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return length(a) < length(b); });
    for (const auto& [a, b] : edges) {
      if (!editable.collapse_tangled(a, b, longest, normals) && !editable.collapse_tangled(b, a, longest, normals))
        continue;
      ++count;
      break;
    }
  }
  compact(editable, mesh);
  return count;
}

std::vector<double> carry_rest_lengths(const std::vector<std::uint64_t>& old_ids, const MeshTopology& old_topology,
                                       const std::vector<double>& old_lengths, const SurfaceMesh& mesh,
                                       const MeshTopology& topology, double edge_length) {
  using Named = std::pair<std::pair<std::uint64_t, std::uint64_t>, double>;  // an edge by the ids of its ends
  std::vector<Named> known(old_lengths.size());
  for (std::size_t e = 0; e < old_lengths.size(); ++e) {
    const auto& [a, b] = old_topology.edges[e];
    known[e] = {std::minmax({old_ids[a], old_ids[b]}), old_lengths[e]};
  }
  std::sort(known.begin(), known.end());
  std::vector<double> lengths = edge_lengths(topology, mesh.positions);
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    const auto& [a, b] = topology.edges[e];
    const std::pair<std::uint64_t, std::uint64_t> ends = std::minmax({mesh.ids[a], mesh.ids[b]});
    const auto found = std::lower_bound(known.begin(), known.end(), Named{ends, -1.0});
    lengths[e] = found != known.end() && found->first == ends
                     ? found->second
                     : std::clamp(lengths[e], 0.7 * edge_length, 1.3 * edge_length);
  }
  return lengths;
}

}  // namespace flowskin::tracking
