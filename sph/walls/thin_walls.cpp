#include "sph/walls/thin_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/triangle.h"
#include "sph/neighbors/point_clusters.h"

namespace flowskin::sph {

namespace {

constexpr double opposed = -0.5;  // cosine of the faces of a thin plate, at least: less than 60 degrees from parallel

Vec3 normal_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vec3& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
}

// For each triangle, whether the surface that it belongs to is open. Corners are told apart by their positions: meshes
// with split vertices are common.
class OpenSurfaces {
 public:
  explicit OpenSurfaces(const TriangleMesh& mesh) {
    std::map<std::array<double, 3>, int> ids;
    for (const auto& t : mesh.triangles) {
      std::array<int, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh.positions[t[k]];
        corners[k] = ids.emplace(std::array{p.x(), p.y(), p.z()}, static_cast<int>(ids.size())).first->second;
      }
      triangles_.push_back(corners);
    }
    parents_.resize(ids.size());
    for (std::size_t k = 0; k < parents_.size(); ++k) parents_[k] = static_cast<int>(k);
    open_.resize(ids.size());
    std::map<std::array<int, 2>, int> uses;
    for (const auto& t : triangles_) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (a == b) continue;
        ++uses[{std::min(a, b), std::max(a, b)}];
        parents_[root(a)] = root(b);
      }
    }
    for (const auto& [edge, count] : uses) {
      if (count == 1) open_[root(edge[0])] = true;
    }
  }

  bool contains(std::size_t triangle) { return open_[root(triangles_[triangle][0])]; }

 private:
  int root(int k) {
    while (parents_[k] != k) k = parents_[k] = parents_[parents_[k]];
    return k;
  }

  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> parents_;
  std::vector<bool> open_;
};

// Calls visit(p) for points of a triangle about a spacing apart, but for not too many, until it says true.
template <typename Visit>
bool any_point(const TriangleMesh& mesh, const std::array<int, 3>& t, double spacing, Visit visit) {
  const Vec3 &a = mesh.positions[t[0]], u = mesh.positions[t[1]] - a, v = mesh.positions[t[2]] - a;
  const int pieces = std::clamp(static_cast<int>(std::max({u.norm(), v.norm(), (u - v).norm()}) / spacing), 1, 20);
  for (int i = 0; i < pieces; ++i) {
    for (int j = 0; i + j < pieces; ++j) {
      if (visit(Vec3(a + (i + 1.0 / 3) / pieces * u + (j + 1.0 / 3) / pieces * v))) return true;
    }
  }
  return false;
}

// Whether another face is opposite the point p of a triangle, within reach.
bool has_face_behind(const WallGuard& guard, const Vec3& p, const Vec3& normal, double spacing, double reach) {
  std::vector<std::uint32_t> near;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 a = p + 1e-3 * spacing * side * normal, b = p + reach * side * normal;
    guard.query(a.cwiseMin(b), a.cwiseMax(b), near);
    const WallGuard::Crossing face = guard.check(a, b, near);
    if (face.crossed && std::abs(face.normal.dot(normal)) > -opposed) return true;
  }
  return false;
}

// Where a line of sight crosses a wall.
struct Cut {
  double share;  // of the way, 0 to 1
  Vec3 normal;   // towards its beginning
};

// The rim of a triangle counts, widened by a hair: no line slips between two triangles that share an edge.
void add_cut(const WallGuard::Triangle& wall, const Vec3& from, const Vec3& to, std::vector<Cut>& cuts) {
  const double from_height = wall.normal.dot(from - wall.a), to_height = wall.normal.dot(to - wall.a);
  if ((from_height > 0) == (to_height > 0)) return;
  const double share = from_height / (from_height - to_height);
  const Vec3 p = from + share * (to - from);
  const double hair = 1e-6 * (to - from).norm();
  if ((closest_on_triangle(p, wall.a, wall.b, wall.c, wall.normal) - p).norm() > hair) return;
  cuts.push_back({share, from_height > 0 ? wall.normal : Vec3(-wall.normal)});
}

struct Bounds {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

  Bounds() = default;
  explicit Bounds(const WallGuard::Triangle& t)
      : low(t.a.cwiseMin(t.b).cwiseMin(t.c)), high(t.a.cwiseMax(t.b).cwiseMax(t.c)) {}
  void include(const Vec3& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  bool meets(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
  }
};

// Crossings at the same place are one: the line meets an edge that two triangles share.
bool is_hidden(std::vector<Cut>& cuts) {
  if (cuts.empty()) return false;
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.share < b.share; });
  const auto same = [](const Cut& a, const Cut& b) { return b.share - a.share < 1e-6; };
  cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
  if (cuts.size() != 2) return true;
  return -cuts[0].normal.dot(cuts[1].normal) < opposed;
}

}  // namespace

ThinWalls::ThinWalls(const std::vector<TriangleMesh>& meshes, const WallGuard& guard, double spacing, double reach,
                     const PeriodicBox& periodic, const Box& place)
    : reach_(reach) {
  std::vector<TriangleMesh> thin;
  for (const TriangleMesh& mesh : meshes) {
    OpenSurfaces open(mesh);
    TriangleMesh part;
    part.positions = mesh.positions;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 normal = normal_of(mesh, mesh.triangles[t]);
      const bool counts = open.contains(t) || any_point(mesh, mesh.triangles[t], spacing, [&](const Vec3& p) {
                            return has_face_behind(guard, p, normal, spacing, reach);
                          });
      if (counts) part.triangles.push_back(mesh.triangles[t]);
    }
    if (!part.triangles.empty()) thin.push_back(std::move(part));
  }
  if (thin.empty()) return;
  guard_ = WallGuard(thin, 2 * spacing, periodic, place);
  // A cluster reaches 1.5 spacings from its middle along each axis, its lists as far again as they reach.
  cells_ = guard_.cells_within(1.5 * spacing + reach);
}

bool ThinWalls::near(const Vec3& center) const {
  return !cells_.empty() && std::binary_search(cells_.begin(), cells_.end(), guard_.cell_at(center));
}

void ThinWalls::hide(std::span<const Vec3> targets, std::span<const Vec3> sources,
                     std::vector<std::uint8_t>& hidden) const {
  Bounds own, all_places;
  for (const Vec3& p : targets) own.include(p);
  all_places = own;
  for (const Vec3& p : sources) all_places.include(p);
  const Vec3 reach = Vec3::Constant(reach_);
  std::vector<std::uint32_t> near;
  guard_.query((own.low - reach).cwiseMax(all_places.low), (own.high + reach).cwiseMin(all_places.high), near);
  // On which side of a wall's plane the targets are, a bit each. Most walls have everything on one side.
  const auto in_front = [&](const WallGuard::Triangle& wall, const Vec3& p) { return wall.normal.dot(p - wall.a) > 0; };
  std::vector<std::uint8_t> fronts;
  std::vector<Bounds> bounds;
  const unsigned all = (1U << targets.size()) - 1;
  std::erase_if(near, [&](std::uint32_t t) {
    const WallGuard::Triangle& wall = guard_.triangle(t);
    const Bounds wall_bounds(wall);
    if (!wall_bounds.meets(all_places)) return true;
    unsigned front = 0;
    for (std::size_t k = 0; k < targets.size(); ++k) front |= static_cast<unsigned>(in_front(wall, targets[k])) << k;
    const auto same_side = [&](const Vec3& p) { return in_front(wall, p) == (front != 0); };
    if ((front == 0 || front == all) && std::all_of(sources.begin(), sources.end(), same_side)) return true;
    fronts.push_back(static_cast<std::uint8_t>(front));
    bounds.push_back(wall_bounds);
    return false;
  });
  if (near.empty()) return;
  std::array<std::vector<Cut>, PointCluster::width> cuts;
  for (std::size_t j = 0; j < sources.size(); ++j) {
    for (auto& of_target : cuts) of_target.clear();
    Bounds lines = own;
    lines.include(sources[j]);
    for (std::size_t w = 0; w < near.size(); ++w) {
      if (!lines.meets(bounds[w])) continue;
      const WallGuard::Triangle& wall = guard_.triangle(near[w]);
      const unsigned apart = in_front(wall, sources[j]) ? all & ~unsigned{fronts[w]} : fronts[w];
      for (std::size_t k = 0; k < targets.size(); ++k) {
        if (apart >> k & 1U) add_cut(wall, targets[k], sources[j], cuts[k]);
      }
    }
    for (std::size_t k = 0; k < targets.size(); ++k) {
      if (is_hidden(cuts[k])) hidden[j] = static_cast<std::uint8_t>(hidden[j] | 1U << k);
    }
  }
}

}  // namespace flowskin::sph
