#include "tracking/remeshing/remesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/edges_by_length.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/keep_vertices.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/velocity/curvature.h"

namespace flowskin::tracking {
namespace {

using Edge = std::array<int, 2>;

constexpr int kSettlingPasses = 6;
constexpr int kSettlingRelaxations = 3;
constexpr int kFewInSettled = 200;  // one operation in so many vertices is left to the first frame

MeshAdjacency topology_of(const SurfaceMesh& mesh) {
  return build_adjacency(static_cast<int>(mesh.positions.size()), mesh.triangles);
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
  const MeshAdjacency topology = topology_of(mesh);
  std::vector<Edge> edges;
  for (int e : edges_by_length(topology, mesh.positions, order, [&](int edge, double length) {
         return condition(length / sizes.of(topology.edges[edge]));
       }))
    edges.push_back(topology.edges[e]);
  return edges;
}

// How far apart the material of the ends of an edge may be (m) for them to count as one body.
double farthest_material(const Edge& edge, double torn, const std::vector<Vec3>& positions) {
  return torn > 0 ? torn * (positions[edge[0]] - positions[edge[1]]).norm() : std::numeric_limits<double>::infinity();
}

// An edge of the surface at one moment: from end to end, with the normals there.
struct EdgeAt {
  Vec3 along, first_normal, second_normal;
  // How far the middle of the surface between the ends lies outside that of the edge, were it a curve of the third
  // degree (Vlachos et al. 2001, Curved PN triangles).
  double sagitta() const { return along.dot(second_normal - first_normal) / 8; }
  // Along the edge, along the surface, outward; not orthonormal where the edge has no length.
  Mat3 frame() const {
    Mat3 axes;
    axes.col(0) = along.normalized();
    axes.col(1) = (first_normal + second_normal).cross(axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  }
};

// The surface at one moment, as far as its edges are asked for.
class SurfaceAt {
 public:
  SurfaceAt(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
      : positions_(positions), normals_(vertex_normals(positions, triangles)) {}
  EdgeAt operator()(const Edge& edge) const {
    return {positions_[edge[1]] - positions_[edge[0]], normals_[edge[0]], normals_[edge[1]]};
  }

 private:
  std::vector<Vec3> positions_, normals_;
};

// A middle is put on the surface. The same move of its material at another moment: turned as the edge is, and as much
// less as the surface was flatter there; nothing where it was bent the other way.
Vec3 move_at(const EdgeAt& then, const EdgeAt& now, const Vec3& move) {
  const double share = std::clamp(then.sagitta() / now.sagitta(), 0.0, 1.0);
  const Vec3 turned = share * then.frame() * now.frame().transpose() * move;
  return turned.allFinite() ? turned : Vec3(Vec3::Zero());
}

int split_long_edges(const std::function<void(std::vector<Vec3>&)>& put_on_surface, double longest, double torn,
                     SurfaceMesh& mesh, Sizes& sizes) {
  const auto edges =
      ordered_edges(mesh, sizes, EdgeOrder::longest_first, [&](double length) { return length > longest; });
  if (edges.empty()) return 0;
  const std::size_t old_count = mesh.positions.size();
  const SurfaceAt now(mesh.positions, mesh.triangles);
  std::vector<std::pair<std::vector<Vec3>*, SurfaceAt>> others;
  for_each_material(mesh, [&](auto& places) { others.emplace_back(&places, SurfaceAt(places, mesh.triangles)); });
  EditableMesh editable(mesh.positions, mesh.triangles);
  std::vector<Edge> split;
  for (const Edge& edge : edges) {
    if (editable.split(edge[0], edge[1]) < 0) continue;
    split.push_back(edge);
    add_middle_attributes(edge[0], edge[1], farthest_material(edge, torn, mesh.positions), mesh);
    sizes.add_middle(edge);
  }
  std::vector<Vec3> born(mesh.positions.begin() + static_cast<std::ptrdiff_t>(old_count), mesh.positions.end());
  put_on_surface(born);
  for (std::size_t i = 0; i < born.size(); ++i) {
    const Vec3 move = born[i] - mesh.positions[old_count + i];
    for (auto& [places, then] : others) (*places)[old_count + i] += move_at(then(split[i]), now(split[i]), move);
    mesh.positions[old_count + i] = born[i];
  }
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
  const MeshAdjacency topology = topology_of(mesh);
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

int edge_between(const MeshAdjacency& topology, int a, int b) {
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
  report.splits = split_long_edges(put_on_surface, longest, settings.torn, mesh, targets);
  report.collapses = collapse_short_edges(settings.shortest * settings.edge_length, longest, mesh, targets);
  report.flips = flip_bad_edges(settings.delaunay_slack, mesh);
  return report;
}

RemeshReport remesh(const ImplicitField& field, const RemeshSettings& settings, SurfaceMesh& mesh) {
  const auto put_on_surface = [&](std::vector<Vec3>& points) {
    project_to_surface(field, default_projection(field.scale()), points);
  };
  return remesh(put_on_surface, settings, mesh, sizes_by_curvature(field, settings, mesh.positions));
}

SurfaceGeometry settled(const ImplicitField& field, const RemeshSettings& settings, SurfaceGeometry surface) {
  SurfaceMesh mesh;
  mesh.positions = std::move(surface.positions);
  mesh.triangles = std::move(surface.triangles);
  mesh.rest_positions = mesh.positions;
  mesh.velocities.assign(mesh.positions.size(), Vec3::Zero());
  mesh.next_id = mesh.positions.size();
  mesh.ids.resize(mesh.positions.size());
  std::iota(mesh.ids.begin(), mesh.ids.end(), std::uint64_t{0});
  const ProjectionSettings projection = default_projection(field.scale());
  for (int pass = 0; pass < kSettlingPasses; ++pass) {
    const RemeshReport done = remesh(field, settings, mesh);
    const int few = static_cast<int>(mesh.positions.size()) / kFewInSettled;
    if (done.splits + done.collapses + done.flips <= few) break;
    std::vector<Vec3> normals = project_to_surface(field, projection, mesh.positions).normals;
    relax(field, projection, topology_of(mesh), mesh.triangles, kSettlingRelaxations, {}, mesh.positions, normals,
          Ridges::kept);
  }
  return {std::move(mesh.positions), std::move(mesh.triangles)};
}

std::vector<double> sizes_by_curvature(const ImplicitField& field, const RemeshSettings& settings,
                                       const std::vector<Vec3>& positions) {
  if (!(settings.curvature > 0)) return {};
  std::vector<double> sizes(positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::ptrdiff_t v = 0; v < std::ssize(sizes); ++v) {
    const MotionJet jet = field.motion_jet(positions[v]);
    const Curvatures curvature = curvatures(jet.gradient, jet.hessian);
    // The principal curvatures are H + s and H - s.
    const double s = std::sqrt(std::max(0.0, curvature.mean * curvature.mean - curvature.gaussian));
    const double sharpest = std::abs(curvature.mean) + s;
    const double wanted = settings.curvature / (sharpest * settings.edge_length);
    sizes[v] = std::isfinite(wanted) ? std::clamp(wanted, settings.finest, 1.0) : 1;
  }
  return sizes;
}

std::vector<double> carry_rest_lengths(const std::vector<std::uint64_t>& old_ids, const MeshAdjacency& old_topology,
                                       const std::vector<double>& old_lengths, const SurfaceMesh& mesh,
                                       const MeshAdjacency& topology, double edge_length) {
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
