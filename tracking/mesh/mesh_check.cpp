#include "tracking/mesh/mesh_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/vertex_attributes.h"

namespace flowskin::tracking {
namespace {

// Counts the faults of one kind and remembers the first.
class Fault {
 public:
  explicit Fault(std::string kind) : kind_(std::move(kind)) {}
  void found(const std::string& place) {
    if (count_++ == 0) first_ = place;
  }
  void report(std::vector<std::string>& problems) const {
    if (count_ > 0) problems.push_back(std::to_string(count_) + " " + kind_ + ", the first at " + first_);
  }

 private:
  std::string kind_, first_;
  int count_ = 0;
};

std::string vertex_name(int vertex) { return "vertex " + std::to_string(vertex); }
std::string triangle_name(int triangle) { return "triangle " + std::to_string(triangle); }

void check_finite(const std::vector<Vec3>& vectors, const std::string& what, std::vector<std::string>& problems) {
  Fault fault(what + " not finite");
  for (int v = 0; v < static_cast<int>(vectors.size()); ++v) {
    if (!vectors[v].allFinite()) fault.found(vertex_name(v));
  }
  fault.report(problems);
}

// False where an index is out of range: nothing else can be checked then.
bool check_indices(int vertex_count, const std::vector<Triangle>& triangles, std::vector<std::string>& problems) {
  Fault out_of_range("triangles with a vertex index out of range");
  Fault repeated("triangles that name a vertex twice");
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= vertex_count) {
      out_of_range.found(triangle_name(t));
    } else if (a == b || b == c || c == a) {
      repeated.found(triangle_name(t));
    }
  }
  const std::size_t before = problems.size();
  out_of_range.report(problems);
  repeated.report(problems);
  return problems.size() == before;
}

void check_duplicates(const std::vector<Vec3>& positions, std::vector<std::string>& problems) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int a, int b) {
    const Vec3 &x = positions[a], &y = positions[b];
    return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return less(a, b) || (!less(b, a) && a < b); });
  Fault fault("vertices at the place of another one");
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (positions[order[i]] == positions[order[i - 1]]) fault.found(vertex_name(order[i]));
  }
  fault.report(problems);
}

// Every directed edge once, and its opposite once.
void check_edges(const std::vector<Triangle>& triangles, std::vector<std::string>& problems) {
  struct DirectedEdge {
    int low, high, triangle;
    bool upward;
  };
  std::vector<DirectedEdge> sides;
  sides.reserve(3 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = triangles[t][corner];
      const int b = triangles[t][(corner + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  Fault open("open edges (in one triangle only)");
  Fault crowded("edges in more than two triangles");
  Fault turned("edges whose two triangles are turned against each other");
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    const std::string place = "edge " + std::to_string(sides[begin].low) + "-" + std::to_string(sides[begin].high) +
                              " of " + triangle_name(sides[begin].triangle);
    if (end - begin == 1) open.found(place);
    if (end - begin > 2) crowded.found(place);
    if (end - begin == 2 && sides[begin].upward == sides[begin + 1].upward) turned.found(place);
  }
  open.report(problems);
  crowded.report(problems);
  turned.report(problems);
}

// Walks from triangle to triangle over the edges at the vertex; a single fan is reached as a whole.
bool single_fan(int vertex, const MeshAdjacency& topology, const std::vector<Triangle>& triangles) {
  const auto star = topology.star(vertex);
  std::vector<char> reached(star.size(), 0);
  std::vector<std::size_t> open{0};
  reached[0] = 1;
  std::size_t count = 0;
  const auto shares_edge = [&](int s, int t) {
    for (int a : triangles[s]) {
      if (a != vertex && std::find(triangles[t].begin(), triangles[t].end(), a) != triangles[t].end()) return true;
    }
    return false;
  };
  while (!open.empty()) {
    const std::size_t current = open.back();
    open.pop_back();
    ++count;
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (!reached[i] && shares_edge(star[current], star[i])) {
        reached[i] = 1;
        open.push_back(i);
      }
    }
  }
  return count == star.size();
}

void check_vertices(int vertex_count, const std::vector<Triangle>& triangles, std::vector<std::string>& problems) {
  const MeshAdjacency topology = build_adjacency(vertex_count, triangles);
  Fault unreferenced("unreferenced vertices");
  Fault pinched("vertices where parts of the surface only touch (not two-manifold)");
  for (int vertex = 0; vertex < vertex_count; ++vertex) {
    if (topology.star(vertex).empty()) {
      unreferenced.found(vertex_name(vertex));
    } else if (!single_fan(vertex, topology, triangles)) {
      pinched.found(vertex_name(vertex));
    }
  }
  unreferenced.report(problems);
  pinched.report(problems);
}

// How often the surface without one component winds around a point, from the solid angles of its triangles
// (Van Oosterom and Strackee 1983).
double winding_number(const Vec3& x, int excluded, const MeshComponents& components, const std::vector<Vec3>& positions,
                      const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& triangle : triangles) {
    if (components.of_vertex[triangle[0]] == excluded) continue;
    const Vec3 a = positions[triangle[0]] - x, b = positions[triangle[1]] - x, c = positions[triangle[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

void check_outward(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                   std::vector<std::string>& problems) {
  const MeshComponents components = mesh_components(positions, triangles);
  Fault inward("parts of the surface that are inside out (or enclose nothing)");
  for (int component = 0; component < components.count; ++component) {
    if (components.volumes[component] > 0) continue;
    const auto first = std::find(components.of_vertex.begin(), components.of_vertex.end(), component);
    const auto vertex = first - components.of_vertex.begin();
    if (winding_number(positions[vertex], component, components, positions, triangles) > 0.5) continue;  // a cavity
    inward.found(vertex_name(static_cast<int>(vertex)));
  }
  inward.report(problems);
}

void check_ids(const SurfaceMesh& mesh, std::vector<std::string>& problems) {
  std::vector<std::uint64_t> ids = mesh.ids;
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end()) problems.push_back("the vertex id " + std::to_string(*twice) + " is used more than once");
  if (!ids.empty() && ids.back() >= mesh.next_id) {
    problems.push_back("the vertex id " + std::to_string(ids.back()) + " is not below next_id, which is " +
                       std::to_string(mesh.next_id));
  }
}

}  // namespace

std::vector<std::string> connection_problems(int vertex_count, const std::vector<Triangle>& triangles) {
  std::vector<std::string> problems;
  if (check_indices(vertex_count, triangles, problems)) check_edges(triangles, problems);
  return problems;
}

std::vector<std::string> mesh_problems(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  std::vector<std::string> problems;
  const int vertex_count = static_cast<int>(positions.size());
  check_finite(positions, "vertex positions", problems);
  const bool finite = problems.empty();
  if (!check_indices(vertex_count, triangles, problems)) return problems;
  if (finite) check_duplicates(positions, problems);
  check_edges(triangles, problems);
  check_vertices(vertex_count, triangles, problems);
  // What is inside and outside has a meaning only for a closed, oriented surface.
  if (problems.empty()) check_outward(positions, triangles, problems);
  return problems;
}

std::vector<std::string> mesh_problems(const SurfaceMesh& mesh) {
  std::vector<std::string> problems = mesh_problems(mesh.positions, mesh.triangles);
  const std::size_t count = mesh.positions.size();
  const auto check_size = [&](std::size_t size, const std::string& what) {
    if (size != count) {
      problems.push_back("there are " + std::to_string(size) + " " + what + " for " + std::to_string(count) +
                         " vertices");
    }
  };
  for_each_attribute(
      mesh, [&](Carried, std::string_view name, const auto& values) { check_size(values.size(), std::string(name)); });
  for_each_attribute(mesh, [&](Carried, std::string_view name, const auto& values) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(values)>, std::vector<Vec3>>)
      check_finite(values, std::string(name), problems);
  });
  check_ids(mesh, problems);
  return problems;
}

}  // namespace flowskin::tracking
