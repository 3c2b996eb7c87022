#include "sph/walls/gaps_between.h"

#include <algorithm>

namespace flowskin::sph {

// At the start the pose of before to the bit, at the end that of now: the next path begins just where this one ends.
Vec3 MetWall::at_rest(const Vec3& from, const Vec3& to, double share) const {
  if (share <= 0) return before->to_rest(from + shift);
  const Vec3 end = now->to_rest(to + shift);
  if (share >= 1) return end;
  const Vec3 start = before->to_rest(from + shift);
  return start + share * (end - start);
}

GapsBetween::Gap GapsBetween::gap_at(const Vec3& from, const Vec3& to, double share) const {
  std::vector<WallGuard::Touch> touches;
  int met = 0;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const MetWall& wall = walls_[w];
    const std::size_t first = touches.size();
    if (!wall.guard->add_touches(wall.at_rest(from, to, share), *wall.triangles, touches)) return {};
    met += touches.size() > first;
    const Pose& pose = share <= 0 ? *wall.before : *wall.now;
    for (std::size_t k = first; k < touches.size(); ++k) {
      touches[k].wall = static_cast<std::uint32_t>(w);
      touches[k].way = pose.rotation * touches[k].way;
      touches[k].place = touches[k].way;  // seen from the point
    }
  }
  if (met < 2) return {};
  const auto is_nearest = [&](const WallGuard::Touch& touch) {
    return walls_[touch.wall].guard->is_nearest_around(touch, touches);
  };
  const WallGuard::Facing facing =
      WallGuard::narrowest(touches, width_, [&](const WallGuard::Touch& a, const WallGuard::Touch& b) {
        return a.wall != b.wall && is_nearest(a) && is_nearest(b);
      });
  if (!facing.found) return {};
  return {true, facing.out, {touches[facing.first].wall, touches[facing.second].wall}};
}

GapsBetween::Gap GapsBetween::enter(const Vec3& from, const Vec3& to) const {
  double length = 0;
  for (const MetWall& wall : walls_) {
    length = std::max(length, (wall.at_rest(from, to, 1) - wall.at_rest(from, to, 0)).norm());
  }
  const int pieces = WallGuard::path_pieces(length, width_);
  for (int k = 1; k <= pieces; ++k) {
    const Gap gap = gap_at(from, to, double(k) / pieces);
    if (gap.found) return gap_at(from, to, 0).found ? Gap{} : gap;
  }
  return {};
}

std::vector<GapsBetween::Way> GapsBetween::ways_around(const Gap& gap, const Vec3& from, const Vec3& to) const {
  const double out = gap.out.norm();
  const bool has_mouth = out > 1e-3 * width_;
  const Vec3 outwards = has_mouth ? Vec3(gap.out / out) : Vec3(Vec3::Zero());
  std::vector<Way> along, resting, ways;
  for (const std::size_t wall : gap.sides) {
    const Vec3 carried = walls_[wall].carried(from), way = to - carried;
    const double inwards = -way.dot(outwards), length = way.norm();
    if (inwards > 0) along.push_back({to + inwards * outwards, outwards, wall});
    if (length > 0) resting.push_back({carried, inwards > 0 ? outwards : Vec3(-way / length), wall});
  }
  const auto asks_less = [&](const Way& a, const Way& b) { return (a.to - to).norm() < (b.to - to).norm(); };
  for (std::vector<Way>* group : {&along, &resting}) {
    std::stable_sort(group->begin(), group->end(), asks_less);
    ways.insert(ways.end(), group->begin(), group->end());
  }
  if (!has_mouth) return ways;
  // The mouth has moved, as where a rotor's tip passes a corner: a little farther out.
  for (const double share : {0.05, 0.1, 0.2}) {
    for (const Way& way : resting) ways.push_back({way.to + share * width_ * outwards, outwards, way.wall});
  }
  return ways;
}

}  // namespace flowskin::sph
