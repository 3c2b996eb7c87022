#include "tracking/field/metaballs/group_sums.h"

#include <array>
#include <cstddef>

#include "tracking/field/metaballs/metaball_sums.h"

namespace flowskin::tracking {
namespace {

/// Calls visit(group, ex, ey, ez, u, inside) for every group, with e = (x - x_i) / radius and u = 1 - |e|^2.
template <class Visit>
void for_each_group(const NearGroups& near, const Vec3& x, const Visit& visit) {
  const double per_radius = 1 / near.radius;
  for (const int group : near.groups) {
    const GroupVectors& places = near.blocks.positions(group);
    const Lanes ex = (x.x() - places.x) * per_radius;
    const Lanes ey = (x.y() - places.y) * per_radius;
    const Lanes ez = (x.z() - places.z) * per_radius;
    const Lanes u = 1 - (ex * ex + ey * ey + ez * ez);
    const LaneMask inside = u > 0;
    visit(group, ex, ey, ez, u, inside);
  }
}

/// Four particles as a point sees them.
struct Seen {
  Lanes dx, dy, dz;  // from the particles to the point (m)
  Lanes u;           // 1 - |e|^2 as above, 0 beyond the radius
};

inline Seen seen_from(const Vec3& x, const GroupVectors& places, double per_square) {
  Seen seen{x.x() - places.x, x.y() - places.y, x.z() - places.z, {}};
  const Lanes inner = 1 - (seen.dx * seen.dx + seen.dy * seen.dy + seen.dz * seen.dz) * per_square;
  seen.u = inner > 0 ? inner : Lanes{};
  return seen;
}

}  // namespace

double kernel_sum(const NearGroups& near, const Vec3& x) {
  Lanes sum{};
  for (const int group : near.groups) {
    const Lanes u = seen_from(x, near.blocks.positions(group), near.per_square).u;
    sum += u * u * u;
  }
  return lane_sum(sum);
}

double kernel_sum(const NearGroups& near, const Vec3& x, Vec3& gradient_sum) {
  Lanes sum{}, gx{}, gy{}, gz{};
  for (const int group : near.groups) {
    const Seen seen = seen_from(x, near.blocks.positions(group), near.per_square);
    const Lanes u2 = seen.u * seen.u;
    sum += u2 * seen.u;
    gx += u2 * seen.dx;
    gy += u2 * seen.dy;
    gz += u2 * seen.dz;
  }
  gradient_sum = Vec3(lane_sum(gx), lane_sum(gy), lane_sum(gz));
  return lane_sum(sum);
}

MotionJet jet_of(const NearGroups& near, const Vec3& x, const FieldSettings& settings) {
  constexpr int capacity = 32;
  std::array<NeighborLanes, capacity> lanes;
  const bool moving = near.blocks.moving();
  int count = 0;
  const Lanes zero{};
  LaneMask neighbors{};
  MetaballSums sums;
  for_each_group(
      near, x,
      [&](int group, const Lanes& ex, const Lanes& ey, const Lanes& ez, const Lanes& u, const LaneMask& inside) {
        if (count == capacity) {
          sums.add(lanes.data(), count, moving);
          count = 0;
        }
        NeighborLanes& next = lanes[count];
        next.ex = inside ? ex : zero;
        next.ey = inside ? ey : zero;
        next.ez = inside ? ez : zero;
        next.u = inside ? u : zero;
        if (moving) {
          const GroupVectors& velocities = near.blocks.velocities(group);
          next.vx = velocities.x;
          next.vy = velocities.y;
          next.vz = velocities.z;
        }
        neighbors -= inside;                          // a lane of a mask is 0 or -1
        count += static_cast<int>(any_lane(inside));  // without a branch, which could not be foretold
      });
  sums.add(lanes.data(), count, moving);
  MotionJet jet = sums.jet(settings);
  jet.neighbors = static_cast<int>(neighbors[0] + neighbors[1] + neighbors[2] + neighbors[3]);
  return jet;
}

void add_moments(const NearGroups& near, const Vec3& x, double share, KernelMoments& moments) {
  const Lanes zero{};
  std::array<Lanes, 3> gradient{};
  std::array<Lanes, 6> u2_ee{}, u_ee{};
  std::array<Lanes, 10> u_eee{};
  std::array<Lanes, 15> eeee{};
  for_each_group(
      near, x,
      [&](int /*group*/, const Lanes& ex, const Lanes& ey, const Lanes& ez, const Lanes& u, const LaneMask& inside) {
        if (!any_lane(inside)) return;
        const std::array<Lanes, 3> e = {inside ? ex : zero, inside ? ey : zero, inside ? ez : zero};
        const Lanes u_in = inside ? u : zero;
        // In lexicographic order of ascending indices.
        std::size_t second = 0, third = 0, fourth = 0;
        for (int a = 0; a < 3; ++a) {
          gradient[a] += u_in * u_in * e[a];
          for (int b = a; b < 3; ++b) {
            const Lanes ee = e[a] * e[b];
            const Lanes uee = u_in * ee;
            u_ee[second] += uee;
            u2_ee[second++] += u_in * uee;
            for (int c = b; c < 3; ++c) {
              u_eee[third++] += uee * e[c];
              for (int d = c; d < 3; ++d) eeee[fourth++] += ee * e[c] * e[d];
            }
          }
        }
      });
  const auto sum = [share](const auto& lanes, auto& sums) {
    for (std::size_t i = 0; i < lanes.size(); ++i) sums[i] += share * lane_sum(lanes[i]);
  };
  sum(u2_ee, moments.u2_ee);
  sum(u_ee, moments.u_ee);
  sum(u_eee, moments.u_eee);
  sum(eeee, moments.eeee);
  for (int a = 0; a < 3; ++a) moments.gradient[a] -= 6 * share * lane_sum(gradient[a]);
}

}  // namespace flowskin::tracking
