#include "tracking/mesh/editable_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

constexpr int kUsualStar = 8;         // triangles at a vertex
constexpr double kLargestTurn = 0.5;  // cosine of 60 degrees
constexpr double kSliver = 0.15;      // shape() of a triangle not to be made
constexpr double kTinyEdge = 0.15;    // of the longest edge
constexpr double kFlat = 0.8;         // cosine of the largest angle between triangles whose edge may be flipped

bool contains(const Triangle& triangle, int vertex) {
  return std::find(triangle.begin(), triangle.end(), vertex) != triangle.end();
}

// 1 for an equilateral triangle, 0 for a degenerate one.
double shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return squares > 0 ? 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / squares : 0;
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

}  // namespace

double angle_at(const Vec3& x, const Vec3& a, const Vec3& b) {
  return std::atan2((a - x).cross(b - x).norm(), (a - x).dot(b - x));
}

EditableMesh::EditableMesh(std::vector<Vec3>& positions, std::vector<Triangle>& triangles)
    : positions_(positions), triangles_(triangles), stars_(positions.size()) {
  for (std::vector<int>& star : stars_) star.reserve(kUsualStar);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int vertex : triangles[t]) stars_[vertex].push_back(t);
  }
}

std::vector<int> EditableMesh::ring(int vertex) const {
  std::vector<int> neighbors;
  for (int t : stars_[vertex]) {
    for (int other : triangles_[t]) {
      if (other != vertex) neighbors.push_back(other);
    }
  }
  std::sort(neighbors.begin(), neighbors.end());
  neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
  return neighbors;
}

Vec3 EditableMesh::star_normal(int vertex) const {
  Vec3 sum = Vec3::Zero();
  for (int t : stars_[vertex]) sum += doubled_area_vector(positions_, triangles_[t]);
  return sum;
}

bool EditableMesh::wings(int a, int b, std::array<int, 2>& triangles, std::array<int, 2>& opposite) const {
  int count = 0;
  for (int t : stars_[a]) {
    if (!contains(triangles_[t], b)) continue;
    if (count == 2) return false;
    triangles[count] = t;
    for (int vertex : triangles_[t]) {
      if (vertex != a && vertex != b) opposite[count] = vertex;
    }
    ++count;
  }
  return count == 2 && opposite[0] != opposite[1];
}

bool EditableMesh::collapse_keeps_shape(int kept, int removed, double longest_edge, double largest_volume) const {
  const Vec3 outward = star_normal(kept) + star_normal(removed);
  double volume = 0;  // six times the volume that the surface gives up
  // A tiny move does no harm to well shaped triangles, and slivers around it have no shape to lose.
  const bool tiny = (positions_[kept] - positions_[removed]).norm() < kTinyEdge * longest_edge;
  for (int t : stars_[removed]) {
    if (contains(triangles_[t], kept)) continue;
    std::array<Vec3, 3> before, after;
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = triangles_[t][corner];
      before[corner] = positions_[vertex];
      after[corner] = vertex == removed ? positions_[kept] : before[corner];
      if (vertex == removed) continue;
      const double length = (positions_[vertex] - positions_[kept]).norm();
      if (length > longest_edge && length > (positions_[vertex] - positions_[removed]).norm()) return false;
    }
    volume +=
        (after[0] - positions_[removed]).dot((after[1] - positions_[removed]).cross(after[2] - positions_[removed]));
    const double shape_before = shape(before[0], before[1], before[2]);
    if (tiny && shape_before < kSliver) continue;
    if (shape(after[0], after[1], after[2]) < std::min(kSliver, shape_before)) return false;
    // The normal of a sliver is noise; its surroundings say where it should look.
    const Vec3 normal_before =
        shape_before < kSliver ? Vec3(outward.normalized()) : unit_normal(before[0], before[1], before[2]);
    if (!(unit_normal(after[0], after[1], after[2]).dot(normal_before) > kLargestTurn)) return false;
  }
  return std::abs(volume) / 6 <= largest_volume;
}

bool EditableMesh::may_collapse(int kept, int removed) const {
  if (kept == removed || !alive(kept) || !alive(removed)) return false;
  std::array<int, 2> triangles{}, opposite{};
  if (!wings(kept, removed, triangles, opposite)) return false;
  const std::vector<int> kept_ring = ring(kept), removed_ring = ring(removed);
  std::vector<int> common;
  std::set_intersection(kept_ring.begin(), kept_ring.end(), removed_ring.begin(), removed_ring.end(),
                        std::back_inserter(common));
  // Two common neighbours, and more than a tetrahedron: then the links meet in the link of the edge only.
  return common.size() == 2 && ring(opposite[0]).size() > 3 && ring(opposite[1]).size() > 3;
}

void EditableMesh::merge(int kept, int removed) {
  std::array<int, 2> triangles{}, opposite{};
  wings(kept, removed, triangles, opposite);
  for (int t : triangles) {
    for (int vertex : triangles_[t]) std::erase(stars_[vertex], t);
    triangles_[t] = {-1, -1, -1};
  }
  for (int t : stars_[removed]) {
    std::replace(triangles_[t].begin(), triangles_[t].end(), removed, kept);
    stars_[kept].push_back(t);
  }
  stars_[removed].clear();
}

bool EditableMesh::collapse(int kept, int removed, double longest_edge, double largest_volume) {
  if (!may_collapse(kept, removed) || !collapse_keeps_shape(kept, removed, longest_edge, largest_volume)) return false;
  merge(kept, removed);
  return true;
}

int EditableMesh::split(int a, int b) {
  std::array<int, 2> triangles{}, opposite{};
  if (a == b || !alive(a) || !alive(b) || !wings(a, b, triangles, opposite)) return -1;
  const int middle = static_cast<int>(positions_.size());
  positions_.push_back((positions_[a] + positions_[b]) / 2);
  stars_.emplace_back();
  for (int side = 0; side < 2; ++side) {
    // The old triangle keeps a, its new twin gets b.
    const int old = triangles[side], twin = static_cast<int>(triangles_.size());
    Triangle copy = triangles_[old];
    std::replace(copy.begin(), copy.end(), a, middle);
    triangles_.push_back(copy);
    std::replace(triangles_[old].begin(), triangles_[old].end(), b, middle);
    std::replace(stars_[b].begin(), stars_[b].end(), old, twin);
    stars_[opposite[side]].push_back(twin);
    stars_[middle].insert(stars_[middle].end(), {old, twin});
  }
  return middle;
}

bool EditableMesh::wants_flip(int a, int b, double slack) const {
  std::array<int, 2> triangles{}, opposite{};
  if (!alive(a) || !alive(b) || !wings(a, b, triangles, opposite)) return false;
  return angle_at(positions_[opposite[0]], positions_[a], positions_[b]) +
             angle_at(positions_[opposite[1]], positions_[a], positions_[b]) >
         M_PI + slack;
}

bool EditableMesh::flip(int a, int b) {
  std::array<int, 2> triangles{}, opposite{};
  if (!alive(a) || !alive(b) || !wings(a, b, triangles, opposite)) return false;
  if (stars_[a].size() <= 3 || stars_[b].size() <= 3) return false;
  for (int t : stars_[opposite[0]]) {
    if (contains(triangles_[t], opposite[1])) return false;
  }
  // In triangle 0 the edge runs from `from` to `to`; triangle 1 passes it the other way.
  const Triangle& first = triangles_[triangles[0]];
  const auto place = std::find(first.begin(), first.end(), a) - first.begin();
  const bool forward = first[(place + 1) % 3] == b;
  const int from = forward ? a : b, to = forward ? b : a;
  const Vec3 &xf = positions_[from], &xt = positions_[to];
  const Vec3 &x0 = positions_[opposite[0]], &x1 = positions_[opposite[1]];
  const Vec3 old0 = unit_normal(xf, xt, x0), old1 = unit_normal(xt, xf, x1);
  const Vec3 new0 = unit_normal(x0, xf, x1), new1 = unit_normal(x1, xt, x0);
  const Vec3 mean = (old0 + old1).normalized();
  if (!(old0.dot(old1) > kFlat && new0.dot(mean) > kFlat && new1.dot(mean) > kFlat)) return false;

  triangles_[triangles[0]] = {opposite[0], from, opposite[1]};
  triangles_[triangles[1]] = {opposite[1], to, opposite[0]};
  std::erase(stars_[to], triangles[0]);
  std::erase(stars_[from], triangles[1]);
  stars_[opposite[0]].push_back(triangles[1]);
  stars_[opposite[1]].push_back(triangles[0]);
  return true;
}

std::vector<int> EditableMesh::compact() {
  std::vector<int> number(positions_.size(), -1);
  int count = 0;
  for (int vertex = 0; vertex < static_cast<int>(positions_.size()); ++vertex) {
    if (!alive(vertex)) continue;
    positions_[count] = positions_[vertex];
    number[vertex] = count++;
  }
  positions_.resize(count);
  std::erase_if(triangles_, [](const Triangle& triangle) { return triangle[0] < 0; });
  for (Triangle& triangle : triangles_) {
    for (int& vertex : triangle) vertex = number[vertex];
  }
  return number;
}

}  // namespace flowskin::tracking
