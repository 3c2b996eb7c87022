#include "sph/geometry/closed_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "sph/geometry/row_crossing.h"

namespace flowskin::sph {

namespace {

using Edge = std::pair<int, int>;  // the smaller vertex first

// The mesh with one vertex for each position; triangles that are none, or are there already, have corners -1.
std::vector<std::array<int, 3>> welded(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> places;
  std::set<std::array<int, 3>> seen;
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : mesh.triangles) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[static_cast<std::size_t>(t[k])] + Vec3::Zero();  // -0 becomes 0
      corners[k] = places.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(places.size())).first->second;
    }
    std::array<int, 3> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    const bool is_flat = sorted[0] == sorted[1] || sorted[1] == sorted[2];
    if (is_flat || !seen.insert(sorted).second) corners = {-1, -1, -1};
    triangles.push_back(corners);
  }
  return triangles;
}

template <class Visit>
void for_each_edge(const std::array<int, 3>& t, const Visit& visit) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int a = t[k], b = t[(k + 1) % 3];
    visit(Edge{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1);
  }
}

// What of the triangles is left when those at open edges are taken away again and again.
std::vector<char> without_open_edges(const std::vector<std::array<int, 3>>& triangles,
                                     std::map<Edge, std::vector<std::uint32_t>>& users) {
  std::vector<char> kept(triangles.size(), 0);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    kept[i] = triangles[i][0] >= 0;
    if (kept[i]) for_each_edge(triangles[i], [&](const Edge& edge, int) { users[edge].push_back(i); });
  }
  std::vector<std::uint32_t> open;
  for (const auto& [edge, at] : users)
    if (at.size() == 1) open.push_back(at[0]);
  while (!open.empty()) {
    const std::uint32_t i = open.back();
    open.pop_back();
    if (!kept[i]) continue;
    kept[i] = 0;
    for_each_edge(triangles[i], [&](const Edge& edge, int) {
      std::vector<std::uint32_t>& at = users[edge];
      std::erase(at, i);
      if (at.size() == 1) open.push_back(at[0]);
    });
  }
  return kept;
}

// The part that each triangle belongs to, by one of its triangles; parts hang together by edges.
std::vector<std::uint32_t> parts_by_edges(std::size_t count, const std::map<Edge, std::vector<std::uint32_t>>& users) {
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [edge, at] : users)
    for (const std::uint32_t other : at) parent[root(other)] = root(at[0]);
  for (std::uint32_t i = 0; i < count; ++i) parent[i] = root(i);
  return parent;
}

}  // namespace

ClosedParts::ClosedParts(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> triangles = welded(mesh);
  std::map<Edge, std::vector<std::uint32_t>> users;
  const std::vector<char> kept = without_open_edges(triangles, users);
  const std::vector<std::uint32_t> part = parts_by_edges(triangles.size(), users);
  std::vector<char> is_oriented(triangles.size(), 1);  // by part
  for (const auto& [edge, at] : users) {
    int balance = 0;
    for (const std::uint32_t i : at)
      for_each_edge(triangles[i],
                    [&, &wanted = edge](const Edge& other, int sign) { balance += other == wanted ? sign : 0; });
    if (balance != 0) is_oriented[part[at[0]]] = 0;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!kept[i]) continue;
    const auto& t = mesh.triangles[i];
    const auto at = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(t[k])]; };
    triangles_.push_back({at(0), at(1), at(2), is_oriented[part[i]] != 0});
  }
  if (!triangles_.empty()) sort_into_columns();
}

std::size_t ClosedParts::column_of(double value, Eigen::Index axis) const {
  const double share = (value - box_.min[axis]) / std::max(1e-300, box_.max[axis] - box_.min[axis]);
  return std::min(columns_ - 1, static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(columns_))));
}

void ClosedParts::sort_into_columns() {
  constexpr double most_columns = 256;
  box_ = {triangles_[0].a, triangles_[0].a};
  for (const auto& [a, b, c, oriented] : triangles_) {
    box_.min = box_.min.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    box_.max = box_.max.cwiseMax(a).cwiseMax(b).cwiseMax(c);
  }
  columns_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(triangles_.size())), 1.0, most_columns));
  cells_.resize(columns_ * columns_);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const auto& [a, b, c, oriented] = triangles_[i];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    for (std::size_t j = column_of(low.y(), 1); j <= column_of(high.y(), 1); ++j)
      for (std::size_t k = column_of(low.z(), 2); k <= column_of(high.z(), 2); ++k)
        cells_[j * columns_ + k].push_back(i);
  }
}

bool ClosedParts::contains(const Vec3& p) const {
  if (empty() || (p.array() < box_.min.array()).any() || (p.array() > box_.max.array()).any()) return false;
  int winding = 0, crossings = 0;
  for (const std::uint32_t i : cells_[column_of(p.y(), 1) * columns_ + column_of(p.z(), 2)]) {
    const Corners& t = triangles_[i];
    const auto crossing = cross_row(t.a, t.b, t.c, p.y(), p.z());
    if (!crossing || crossing->x > p.x()) continue;
    if (t.is_oriented)
      winding += crossing->sign;
    else
      ++crossings;
  }
  return winding != 0 || crossings % 2 != 0;
}

}  // namespace flowskin::sph
