// Gaps between walls that a particle does not fit into; see WallGuard::enter_gap().
#include <algorithm>
#include <cmath>

#include "common/triangle.h"
#include "sph/neighbors/point_grid.h"
#include "sph/walls/wall_guard.h"

namespace flowskin::sph {

namespace {

constexpr double on_wall = 0.1;  // a middle between two samples nearer to a wall than this share of their distance

bool is_near(const WallGuard::Triangle& t, const Vec3& p, double distance) {
  if (std::abs(t.normal.dot(p - t.a)) > distance) return false;
  return (closest_on_triangle(p, t.a, t.b, t.c, t.normal) - p).norm() < distance;
}

}  // namespace

bool WallGuard::add_touches(const Vec3& p, const std::vector<std::uint32_t>& candidates,
                            std::vector<Touch>& touches) const {
  for (const std::uint32_t k : candidates) {
    const Triangle& t = triangles_[k];
    if (std::abs(t.normal.dot(p - t.a)) >= gap_width_) continue;
    const Vec3 place = closest_on_triangle(p, t.a, t.b, t.c, t.normal);
    const double distance = (place - p).norm();
    if (distance < hair()) return false;
    if (distance < gap_width_) touches.push_back({place, place - p, distance, k, 0, place});
  }
  return true;
}

bool WallGuard::is_nearest_around(const Touch& touch, const std::vector<Touch>& touches) const {
  return std::none_of(touches.begin(), touches.end(), [&](const Touch& other) {
    return other.distance < touch.distance && other.wall == touch.wall &&
           is_near(triangles_[other.triangle], touch.place_at_rest, hair());
  });
}

// A flat wall of many triangles is met in one place only: the nearest points of the other triangles have a nearer one
// beside them.
WallGuard::Crossing WallGuard::gap_at(const Vec3& p, const std::vector<std::uint32_t>& candidates) const {
  std::vector<Touch> touches;
  if (!add_touches(p, candidates, touches)) return {};
  const Facing facing = narrowest(touches, gap_width_, [&](const Touch& a, const Touch& b) {
    return is_nearest_around(a, touches) && is_nearest_around(b, touches);
  });
  return {facing.found, facing.out};
}

int WallGuard::path_pieces(double length, double width) {
  constexpr double pieces = 20;  // in a gap's width
  return static_cast<int>(std::ceil(pieces * length / width));
}

WallGuard::Crossing WallGuard::enter_gap(const Vec3& from, const Vec3& to,
                                         const std::vector<std::uint32_t>& candidates) const {
  if (gap_cells_.empty()) return {};
  const Vec3 way = to - from;
  const double length = way.norm();
  // Cells with a gap reach farther than a path.
  if (!std::binary_search(gap_cells_.begin(), gap_cells_.end(), cell_at(to, gap_width_))) return {};
  const int pieces = path_pieces(length, gap_width_);
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

void WallGuard::query_touching(const Vec3& box_min, const Vec3& box_max, std::vector<std::uint32_t>& found) const {
  query(box_min, box_max, found);
  const Vec3 center = 0.5 * (box_min + box_max), half = 0.5 * (box_max - box_min);
  std::erase_if(found, [&](std::uint32_t k) {
    const Triangle& t = triangles_[k];
    const Vec3 low = t.a.cwiseMin(t.b).cwiseMin(t.c), high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    return (low - box_max).maxCoeff() > 0 || (box_min - high).maxCoeff() > 0 ||
           std::abs(t.normal.dot(center - t.a)) > t.normal.cwiseAbs().dot(half);
  });
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
