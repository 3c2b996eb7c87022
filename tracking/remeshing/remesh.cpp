#include "tracking/remeshing/remesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/mesh/edges_by_length.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/keep_vertices.h"
#include "tracking/velocity/curvature.h"

namespace flowskin::tracking {
namespace {

using Edge = std::array<int, 2>;

MeshTopology topology_of(const SurfaceMesh& mesh) {
  return build_topology(static_cast<int>(mesh.positions.size()), mesh.triangles);
}

// The target at each vertex, in edge lengths.
class Sizes {
 public:
  explicit Sizes(std::vector<double> of_vertex) : of_vertex_(std::move(of_vertex)) {}
  double of(const Edge& edge) const {
    return of_vertex_.empty() ? 1 : std::min(of_vertex_[edge[0]], of_vertex_[edge[1]]);
  }
  void add_middle(const Edge& edge) {
    if (!of_vertex_.empty()) of_vertex_.push_back((of_vertex_[edge[0]] + of_vertex_[edge[1]]) / 2);
  }
  void keep(const std::vector<int>& number) {
    if (!of_vertex_.empty()) keep_numbered(number, of_vertex_);
  }

 private:
  std::vector<double> of_vertex_;
};

// Edges whose length in targets fulfils a condition, as pairs of vertices.
template <class Condition>
std::vector<Edge> ordered_edges(const SurfaceMesh& mesh, const Sizes& sizes, EdgeOrder order,
                                const Condition& condition) {
  const MeshTopology topology = topology_of(mesh);
  std::vector<Edge> edges;
  for (int e : edges_by_length(topology, mesh.positions, order, [&](int edge, double length) {
         return condition(length / sizes.of(topology.edges[edge]));
       }))
    edges.push_back(topology.edges[e]);
  return edges;
}

// What a new vertex in the middle of an edge carries: the mean of the ends, as its position.
void add_middle(const Edge& edge, SurfaceMesh& mesh) {
  const auto& [a, b] = edge;
  mesh.rest_positions.push_back((mesh.rest_positions[a] + mesh.rest_positions[b]) / 2);
  for (auto& layer : mesh.layers) layer.push_back((layer[a] + layer[b]) / 2);
  mesh.velocities.push_back((mesh.velocities[a] + mesh.velocities[b]) / 2);
  mesh.ids.push_back(mesh.next_id++);
}

int split_long_edges(const std::function<void(std::vector<Vec3>&)>& put_on_surface, double longest, SurfaceMesh& mesh,
                     Sizes& sizes) {
  const auto edges =
      ordered_edges(mesh, sizes, EdgeOrder::longest_first, [&](double length) { return length > longest; });
  if (edges.empty()) return 0;
  const std::size_t old_count = mesh.positions.size();
  EditableMesh editable(mesh.positions, mesh.triangles);
  for (const Edge& edge : edges) {
    if (editable.split(edge[0], edge[1]) < 0) continue;
    add_middle(edge, mesh);
    sizes.add_middle(edge);
  }
  std::vector<Vec3> born(mesh.positions.begin() + static_cast<std::ptrdiff_t>(old_count), mesh.positions.end());
  put_on_surface(born);
  std::copy(born.begin(), born.end(), mesh.positions.begin() + static_cast<std::ptrdiff_t>(old_count));
  return static_cast<int>(born.size());
}

int collapse_short_edges(double shortest, double longest, SurfaceMesh& mesh, Sizes& sizes) {
  const auto edges =
      ordered_edges(mesh, sizes, EdgeOrder::shortest_first, [&](double length) { return length < shortest; });
  if (edges.empty()) return 0;
  EditableMesh editable(mesh.positions, mesh.triangles);
  int count = 0;
  for (const Edge& edge : edges) {
    const auto& [low, high] = edge;
    // The older vertex is the better witness of its material.
    const bool low_is_older = mesh.ids[low] < mesh.ids[high];
    const int older = low_is_older ? low : high, younger = low_is_older ? high : low;
    const double limit = longest * sizes.of(edge);
    count += editable.collapse(older, younger, limit) || editable.collapse(younger, older, limit);
  }
  const std::vector<int> number = editable.compact();
  keep_attributes(number, mesh);
  sizes.keep(number);
  return count;
}

double opposite_angle(const SurfaceMesh& mesh, int triangle, const Edge& edge) {
  for (int vertex : mesh.triangles[triangle]) {
    if (vertex != edge[0] && vertex != edge[1])
      return angle_at(mesh.positions[vertex], mesh.positions[edge[0]], mesh.positions[edge[1]]);
  }
  return 0;
}

// Edges whose opposite angles add up to more than 180 degrees and the slack, ascending.
std::vector<Edge> edges_to_flip(double slack, const SurfaceMesh& mesh) {
  const MeshTopology topology = topology_of(mesh);
  std::vector<char> wanted(topology.edges.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t e = 0; e < std::ssize(wanted); ++e) {
    const auto& [first, second] = topology.edge_triangles[e];
    wanted[e] =
        second >= 0 &&
        opposite_angle(mesh, first, topology.edges[e]) + opposite_angle(mesh, second, topology.edges[e]) > M_PI + slack;
  }
  std::vector<Edge> edges;
  for (std::size_t e = 0; e < wanted.size(); ++e) {
    if (wanted[e]) edges.push_back(topology.edges[e]);
  }
  return edges;
}

int flip_bad_edges(double slack, SurfaceMesh& mesh) {
  const std::vector<Edge> edges = edges_to_flip(slack, mesh);
  if (edges.empty()) return 0;
  EditableMesh editable(mesh.positions, mesh.triangles);
  int count = 0;
  for (const auto& [a, b] : edges) count += editable.wants_flip(a, b, slack) && editable.flip(a, b);
  return count;
}

// The vertex that had this id, for each of the new ones; -1 where there was none.
std::vector<int> old_vertices(const std::vector<std::uint64_t>& old_ids, const std::vector<std::uint64_t>& ids) {
  std::vector<std::pair<std::uint64_t, int>> known(old_ids.size());
  for (std::size_t v = 0; v < old_ids.size(); ++v) known[v] = {old_ids[v], static_cast<int>(v)};
  if (!std::is_sorted(known.begin(), known.end())) std::sort(known.begin(), known.end());
  std::vector<int> old_of(ids.size(), -1);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t v = 0; v < std::ssize(ids); ++v) {
    const auto found = std::lower_bound(known.begin(), known.end(), std::pair{ids[v], -1});
    if (found != known.end() && found->first == ids[v]) old_of[v] = found->second;
  }
  return old_of;
}

int edge_between(const MeshTopology& topology, int a, int b) {
  for (const auto& [other, edge] : topology.ring(a)) {
    if (other == b) return edge;
  }
  return -1;
}

}  // namespace

RemeshReport remesh(const std::function<void(std::vector<Vec3>&)>& put_on_surface, const RemeshSettings& settings,
                    SurfaceMesh& mesh, std::vector<double> sizes) {
  RemeshReport report;
  const double longest = settings.longest * settings.edge_length;
  Sizes targets(std::move(sizes));
  report.splits = split_long_edges(put_on_surface, longest, mesh, targets);
  report.collapses = collapse_short_edges(settings.shortest * settings.edge_length, longest, mesh, targets);
  report.flips = flip_bad_edges(settings.delaunay_slack, mesh);
  return report;
}

RemeshReport remesh(const MetaballField& field, const RemeshSettings& settings, SurfaceMesh& mesh) {
  const auto put_on_surface = [&](std::vector<Vec3>& points) {
    project_to_surface(field, default_projection(field.settings()), points);
  };
  return remesh(put_on_surface, settings, mesh, sizes_by_curvature(field, settings, mesh.positions));
}

std::vector<double> sizes_by_curvature(const MetaballField& field, const RemeshSettings& settings,
                                       const std::vector<Vec3>& positions) {
  if (!(settings.curvature > 0)) return {};
  std::vector<double> sizes(positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::ptrdiff_t v = 0; v < std::ssize(sizes); ++v) {
    const Jet jet = field.jet(positions[v]);
    const Curvatures curvature = curvatures(jet.gradient, jet.hessian);
    // The principal curvatures are H + s and H - s.
    const double s = std::sqrt(std::max(0.0, curvature.mean * curvature.mean - curvature.gaussian));
    const double sharpest = std::abs(curvature.mean) + s;
    const double wanted = settings.curvature / (sharpest * settings.edge_length);
    sizes[v] = std::isfinite(wanted) ? std::clamp(wanted, settings.finest, 1.0) : 1;
  }
  return sizes;
}

std::vector<double> carry_rest_lengths(const std::vector<std::uint64_t>& old_ids, const MeshTopology& old_topology,
                                       const std::vector<double>& old_lengths, const SurfaceMesh& mesh,
                                       const MeshTopology& topology, double edge_length) {
  const std::vector<int> old_of = old_vertices(old_ids, mesh.ids);
  std::vector<double> lengths = edge_lengths(topology, mesh.positions);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t e = 0; e < std::ssize(lengths); ++e) {
    const int a = old_of[topology.edges[e][0]], b = old_of[topology.edges[e][1]];
    const int old_edge = a >= 0 && b >= 0 ? edge_between(old_topology, a, b) : -1;
    lengths[e] = old_edge >= 0 ? old_lengths[old_edge] : std::clamp(lengths[e], 0.7 * edge_length, 1.3 * edge_length);
  }
  return lengths;
}

}  // namespace flowskin::tracking
