#include "tracking/repair/patch_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <deque>
#include <utility>

#include "common/closest_point.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr double kFacesWanted = 0.3;       // cosine between a triangle's normal and the one asked for
constexpr double kAtVertex = 0.7;          // weight of a corner from which on it is moved
constexpr double kAtEdge = 0.15;           // weight of a corner up to which its opposite side is split
constexpr double kUprightWhenMoved = 0.3;  // cosine of the largest turn of a triangle when a corner moves
constexpr int kFlipsPerEdge = 40;

// Twice the signed area of a triangle seen against the normal.
double area_along(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c) {
  return normal.dot((b - a).cross(c - a));
}

}  // namespace

struct PatchMesh::Place {
  int triangle = -1;
  std::array<double, 3> weights{};
};

PatchMesh::PatchMesh(std::vector<Vec3> positions, std::vector<Triangle> triangles)
    : positions_(std::move(positions)),
      triangles_(std::move(triangles)),
      stars_(positions_.size()),
      is_fixed_vertex_(positions_.size()) {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    for (int vertex : triangles_[t]) stars_[vertex].push_back(t);
  }
}

int PatchMesh::triangle_at(int a, int b) const {
  for (int t : stars_[a]) {
    const Triangle& triangle = triangles_[t];
    for (int corner = 0; corner < 3; ++corner) {
      if (triangle[corner] == a && triangle[(corner + 1) % 3] == b) return t;
    }
  }
  return -1;
}

int PatchMesh::opposite(int a, int b) const {
  const int t = triangle_at(a, b);
  if (t < 0) return -1;
  for (int vertex : triangles_[t]) {
    if (vertex != a && vertex != b) return vertex;
  }
  return -1;
}

bool PatchMesh::is_fixed(int a, int b) const {
  if (!is_fixed_vertex_[a] || !is_fixed_vertex_[b]) return false;
  const std::array<int, 2> edge = {std::min(a, b), std::max(a, b)};
  return std::find(fixed_edges_.begin(), fixed_edges_.end(), edge) != fixed_edges_.end();
}

bool PatchMesh::on_border(int vertex) const {
  for (int t : stars_[vertex]) {
    for (int other : triangles_[t]) {
      if (other != vertex && (triangle_at(vertex, other) < 0 || triangle_at(other, vertex) < 0)) return true;
    }
  }
  return false;
}

PatchMesh::Place PatchMesh::locate(const Vec3& x, const Vec3& normal, double reach) const {
  Place best;
  double nearest = reach;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const std::array<Vec3, 3> corners = {positions_[triangles_[t][0]], positions_[triangles_[t][1]],
                                         positions_[triangles_[t][2]]};
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    if (((low - x).array() > nearest).any() || ((x - high).array() > nearest).any()) continue;
    const Vec3 area = doubled_area_vector(positions_, triangles_[t]);
    if (!(area.dot(normal) > kFacesWanted * area.norm())) continue;
    std::array<double, 3> weights{};
    const double distance = closest_on_triangle(x, corners, weights);
    if (!(distance < nearest)) continue;
    nearest = distance;
    best = {t, weights};
  }
  return best;
}

bool PatchMesh::move_to(int vertex, const Vec3& x) {
  if (is_fixed_vertex_[vertex] || on_border(vertex)) return false;
  for (int t : stars_[vertex]) {
    const Vec3 before = doubled_area_vector(positions_, triangles_[t]);
    std::array<Vec3, 3> corners{};
    for (int i = 0; i < 3; ++i) corners[i] = triangles_[t][i] == vertex ? x : positions_[triangles_[t][i]];
    const Vec3 after = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!(after.dot(before) > kUprightWhenMoved * after.norm() * before.norm())) return false;
  }
  positions_[vertex] = x;
  return true;
}

void PatchMesh::replace(int triangle, const Triangle& corners) {
  for (int vertex : triangles_[triangle]) std::erase(stars_[vertex], triangle);
  triangles_[triangle] = corners;
  for (int vertex : corners) stars_[vertex].push_back(triangle);
}

int PatchMesh::add(const Triangle& corners) {
  const int triangle = static_cast<int>(triangles_.size());
  triangles_.push_back(corners);
  for (int vertex : corners) stars_[vertex].push_back(triangle);
  return triangle;
}

int PatchMesh::split_triangle(int triangle, const Vec3& x) {
  const int vertex = static_cast<int>(positions_.size());
  positions_.push_back(x);
  stars_.emplace_back();
  is_fixed_vertex_.push_back(0);
  const auto [a, b, c] = triangles_[triangle];
  replace(triangle, {a, b, vertex});
  add({b, c, vertex});
  add({c, a, vertex});
  return vertex;
}

int PatchMesh::split_edge(int a, int b, const Vec3& x) {
  const int left = triangle_at(a, b), right = triangle_at(b, a);
  if (left < 0 || right < 0 || is_fixed(a, b)) return -1;
  const int top = opposite(a, b), bottom = opposite(b, a);
  const int vertex = static_cast<int>(positions_.size());
  positions_.push_back(x);
  stars_.emplace_back();
  is_fixed_vertex_.push_back(0);
  replace(left, {a, vertex, top});
  add({vertex, b, top});
  replace(right, {b, vertex, bottom});
  add({vertex, a, bottom});
  return vertex;
}

int PatchMesh::insert(const Vec3& x, const Vec3& normal, double reach) {
  const Place place = locate(x, normal, reach);
  if (place.triangle < 0) return -1;
  const Triangle triangle = triangles_[place.triangle];
  const auto& weights = place.weights;
  const auto nearest = std::max_element(weights.begin(), weights.end()) - weights.begin();
  const auto farthest = std::min_element(weights.begin(), weights.end()) - weights.begin();
  int vertex = -1;
  if (weights[nearest] > kAtVertex && move_to(triangle[nearest], x)) vertex = triangle[nearest];
  if (vertex < 0 && weights[farthest] < kAtEdge)
    vertex = split_edge(triangle[(farthest + 1) % 3], triangle[(farthest + 2) % 3], x);
  if (vertex < 0 && weights[farthest] > 0) vertex = split_triangle(place.triangle, x);
  if (vertex >= 0) is_fixed_vertex_[vertex] = 1;
  return vertex;
}

void PatchMesh::flip(int a, int b, int left, int right) {
  const int first = triangle_at(a, b), second = triangle_at(b, a);
  replace(first, {left, a, right});
  replace(second, {right, b, left});
}

// The edges that the straight way from a to b crosses, in its order.
bool PatchMesh::crossed_edges(int a, int b, const Vec3& normal, std::vector<std::array<int, 2>>& crossed) const {
  const auto side = [&](int c) { return area_along(normal, positions_[a], positions_[b], positions_[c]); };
  const Vec3 ahead = positions_[b] - positions_[a];
  int right = -1, left = -1;
  for (int t : stars_[a]) {
    const auto corner = std::find(triangles_[t].begin(), triangles_[t].end(), a) - triangles_[t].begin();
    const int c = triangles_[t][(corner + 1) % 3], d = triangles_[t][(corner + 2) % 3];
    if (!(side(c) < 0 && side(d) > 0)) continue;
    // The way leaves this wedge forwards, not backwards.
    const double share = side(d) / (side(d) - side(c));
    const Vec3 exit = positions_[d] + share * (positions_[c] - positions_[d]) - positions_[a];
    if (!(exit.dot(ahead) > 0)) continue;
    right = c, left = d;
  }
  if (right < 0) return false;
  while (true) {
    crossed.push_back({right, left});
    const int next = opposite(left, right);
    if (next < 0 || crossed.size() > triangles_.size()) return false;
    if (next == b) return true;
    const double s = side(next);
    if (s == 0) return false;
    (s < 0 ? right : left) = next;
  }
}

bool PatchMesh::connect(int a, int b, const Vec3& normal) {
  if (a == b) return false;
  if (!has_edge(a, b)) {
    std::vector<std::array<int, 2>> crossed;
    if (!crossed_edges(a, b, normal, crossed)) return false;
    const auto side = [&](int c) { return area_along(normal, positions_[a], positions_[b], positions_[c]); };
    std::deque<std::array<int, 2>> open(crossed.begin(), crossed.end());
    auto left_flips = static_cast<int>(kFlipsPerEdge * open.size());
    while (!open.empty() && left_flips-- > 0) {
      const auto [u, v] = open.front();
      open.pop_front();
      if (is_fixed(u, v)) return false;
      const int left = opposite(u, v), right = opposite(v, u);
      if (left < 0 || right < 0) return false;
      const bool convex = area_along(normal, positions_[right], positions_[v], positions_[left]) > 0 &&
                          area_along(normal, positions_[left], positions_[u], positions_[right]) > 0;
      if (!convex || has_edge(left, right)) {
        open.push_back({u, v});
        continue;
      }
      flip(u, v, left, right);
      const bool at_end = left == a || left == b || right == a || right == b;
      if (!at_end && side(left) * side(right) < 0) open.push_back({left, right});
    }
    if (!has_edge(a, b)) return false;
  }
  if (triangle_at(a, b) < 0 || triangle_at(b, a) < 0) return false;
  fixed_edges_.push_back({std::min(a, b), std::max(a, b)});
  return true;
}

}  // namespace flowskin::tracking
