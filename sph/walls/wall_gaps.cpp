// Gaps between walls that a particle does not fit into; see WallGuard::enter_gap().
#include <algorithm>
#include <cmath>

#include "sph/geometry/triangle_geometry.h"
#include "sph/neighbors/point_grid.h"
#include "sph/walls/wall_guard.h"

namespace flowskin::sph {

namespace {

constexpr double on_wall = 0.1;     // a middle between two samples nearer to a wall than this share of their distance
constexpr double path_pieces = 20;  // pieces of a path, in a gap's width: so finely it is looked at
constexpr double opposite = -0.5;   // cosine: walls in directions more than 120 degrees apart are opposite each other

bool is_near(const WallGuard::Triangle& t, const Vec3& p, double distance) {
  if (std::abs(t.normal.dot(p - t.a)) > distance) return false;
  return (closest_on_triangle(p, t.a, t.b, t.c, t.normal) - p).norm() < distance;
}

}  // namespace

// Where a point touches walls: the nearest point of each triangle within reach.
struct WallGuard::Touch {
  Vec3 place, way;  // m; the way leads from the point to the place
  double distance;
  std::uint32_t triangle;
};

bool WallGuard::is_nearest_around(const Touch& touch, const std::vector<Touch>& touches) const {
  return std::none_of(touches.begin(), touches.end(), [&](const Touch& other) {
    return other.distance < touch.distance && is_near(triangles_[other.triangle], touch.place, hair());
  });
}

WallGuard::Crossing WallGuard::gap_at(const Vec3& p, const std::vector<std::uint32_t>& candidates) const {
  std::vector<Touch> touches;
  for (const std::uint32_t k : candidates) {
    const Triangle& t = triangles_[k];
    if (std::abs(t.normal.dot(p - t.a)) >= gap_width_) continue;
    const Vec3 place = closest_on_triangle(p, t.a, t.b, t.c, t.normal);
    const double distance = (place - p).norm();
    if (distance < hair()) return {};
    if (distance < gap_width_) touches.push_back({place, place - p, distance, k});
  }
  // The narrowest pair of walls opposite each other. A flat wall of many triangles is met in one place only: the
  // nearest points of the other triangles have a nearer one beside them.
  Crossing result;
  double narrowest = gap_width_;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      const Touch &a = touches[k], &b = touches[l];
      if (a.way.dot(b.way) > opposite * a.distance * b.distance) continue;
      const Vec3 across = a.place - b.place;
      const double width = across.norm();
      if (!(width < narrowest) || !is_nearest_around(a, touches) || !is_nearest_around(b, touches)) continue;
      narrowest = width;
      const Vec3 out = -0.5 * (a.way + b.way);
      result = {true, out - out.dot(across) / (width * width) * across};
    }
  }
  return result;
}

WallGuard::Crossing WallGuard::enter_gap(const Vec3& from, const Vec3& to,
                                         const std::vector<std::uint32_t>& candidates) const {
  if (gap_cells_.empty()) return {};
  const Vec3 way = to - from;
  const double length = way.norm();
  // Cells with a gap reach farther than a path.
  if (!std::binary_search(gap_cells_.begin(), gap_cells_.end(), cell_at(to, gap_width_))) return {};
  const int pieces = static_cast<int>(std::ceil(path_pieces * length / gap_width_));
  for (int k = 1; k <= pieces; ++k) {
    Crossing gap = gap_at(from + (double(k) / pieces) * way, candidates);
    if (!gap.crossed) continue;
    if (gap_at(from, candidates).crossed) return {};
    const double out = gap.normal.norm();
    const bool outwards = out > 1e-3 * gap_width_ && way.dot(gap.normal) < 0;
    gap.normal = outwards ? Vec3(gap.normal / out) : Vec3(-way / length);
    return gap;
  }
  return {};
}

bool WallGuard::keep_out(const Vec3& from, const std::vector<std::uint32_t>& candidates, Vec3& to, Vec3& normal) const {
  const Crossing gap = enter_gap(from, to, candidates);
  if (!gap.crossed) return false;
  normal = gap.normal;
  const Vec3 way = to - from;
  to = from + way - std::min(0.0, way.dot(normal)) * normal;
  if (enter_gap(from, to, candidates).crossed || check(from, to, candidates, true).crossed) to = from;
  return true;
}

void WallGuard::find_gaps(const std::vector<Vec3>& samples, double sample_spacing, double width,
                          const PeriodicBox& periodic) {
  gap_width_ = width;
  gap_cells_.clear();
  // Somewhere in a gap is the middle between two samples, one on each of its sides.
  const double reach = width + sample_spacing;
  const Vec3 margin = Vec3::Constant(reach);
  PointGrid grid(reach);
  for (const Vec3& p : samples) {
    periodic.for_each_touching_image(p - margin, p + margin, [&](const Vec3& shift) { grid.insert(p + shift); });
  }
#pragma omp parallel
  {
    std::vector<std::uint32_t> near;
    std::vector<std::uint64_t> found;
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Vec3& a = samples[k];
      query(a - margin, a + margin, near);
      grid.for_each_near(a, reach, [&](const Vec3& b) {
        const bool other_way_round = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
        const Vec3 middle = 0.5 * (a + b);
        if (other_way_round || is_on_wall(middle, on_wall * (a - b).norm(), near)) return false;
        if (!gap_at(middle, near).crossed) return false;
        periodic.for_each_touching_image(middle - margin, middle + margin, [&](const Vec3& shift) {
          const Vec3 around = Vec3::Constant(gap_width_);
          for_each_cell(middle + shift - around, middle + shift + around, gap_width_,
                        [&](std::uint64_t cell) { found.push_back(cell); });
        });
        return false;
      });
    }
#pragma omp critical
    gap_cells_.insert(gap_cells_.end(), found.begin(), found.end());
  }
  std::sort(gap_cells_.begin(), gap_cells_.end());
  gap_cells_.erase(std::unique(gap_cells_.begin(), gap_cells_.end()), gap_cells_.end());
}

bool WallGuard::is_on_wall(const Vec3& p, double distance, const std::vector<std::uint32_t>& candidates) const {
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](std::uint32_t k) { return is_near(triangles_[k], p, distance); });
}

bool WallGuard::collect(const Vec3& low, const Vec3& high, double margin, std::vector<std::uint32_t>& found) const {
  const bool near = near_gap(low - Vec3::Constant(margin), high + Vec3::Constant(margin));
  const Vec3 reach = Vec3::Constant(near ? margin + gap_width_ : margin);
  query(low - reach, high + reach, found);
  return near;
}

bool WallGuard::near_gap(const Vec3& low, const Vec3& high) const {
  if (gap_cells_.empty()) return false;
  bool near = false;
  for_each_cell(low, high, gap_width_, [&](std::uint64_t cell) {
    near = near || std::binary_search(gap_cells_.begin(), gap_cells_.end(), cell);
  });
  return near;
}

}  // namespace flowskin::sph
