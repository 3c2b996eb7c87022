#include "tracking/field/metaball_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "tracking/field/metaball_sums.h"
#include "tracking/field/particle_blocks.h"

namespace flowskin::tracking {
namespace {

bool positive(double a) { return std::isfinite(a) && a > 0; }

void check_finite(const std::vector<Vec3>& vectors, const char* what) {
  const auto bad = std::find_if(vectors.begin(), vectors.end(), [](const Vec3& v) { return !v.allFinite(); });
  if (bad == vectors.end()) return;
  throw std::invalid_argument("MetaballField: the " + std::string(what) + " of particle " +
                              std::to_string(bad - vectors.begin()) +
                              " is not finite; remove the particle or check where it comes from");
}

void check(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, const FieldSettings& settings) {
  if (!positive(settings.radius)) {
    throw std::invalid_argument("MetaballField: radius is " + std::to_string(settings.radius) +
                                "; expected a positive length (m), see default_field_settings");
  }
  if (!positive(settings.weight) || !std::isfinite(settings.threshold)) {
    throw std::invalid_argument("MetaballField: weight is " + std::to_string(settings.weight) + ", threshold is " +
                                std::to_string(settings.threshold) + "; expected a positive and a finite number");
  }
  if (!velocities.empty() && velocities.size() != positions.size()) {
    throw std::invalid_argument("MetaballField: " + std::to_string(velocities.size()) + " velocities for " +
                                std::to_string(positions.size()) + " positions; expected as many, or none");
  }
  check_finite(positions, "position");
  check_finite(velocities, "velocity");
}

/// Where a thread keeps the numbers of the groups near its point, so that queries do not allocate.
std::vector<int>& group_scratch() {
  thread_local std::vector<int> found;
  return found;
}

}  // namespace

FieldSettings default_field_settings(double spacing, double radius_in_spacings) {
  if (!positive(spacing) || !positive(radius_in_spacings)) {
    throw std::invalid_argument("default_field_settings: spacing is " + std::to_string(spacing) + ", radius is " +
                                std::to_string(radius_in_spacings) + " spacings; expected positive numbers");
  }
  FieldSettings settings;
  settings.radius = radius_in_spacings * spacing;
  // Half of what the sum is on average deep inside: integral of (1 - r^2)^3 over the unit ball = 4 pi 16 / 315.
  settings.threshold = 0.5 * settings.weight * (64 * std::numbers::pi / 315) * std::pow(radius_in_spacings, 3);
  return settings;
}

struct MetaballField::Impl {
  Impl(std::vector<Vec3> particle_positions, std::vector<Vec3> particle_velocities, const FieldSettings& field_settings)
      : settings((check(particle_positions, particle_velocities, field_settings), field_settings)),
        positions(std::move(particle_positions)),
        velocities(std::move(particle_velocities)),
        blocks(positions, velocities, settings.radius) {}

  /// Calls visit(group, ex, ey, ez, u, inside) for every four particles of which some may be nearer than sigma.
  template <class Visit>
  void for_each_group(const Vec3& x, const Visit& visit) const {
    std::vector<int>& near = group_scratch();
    const int count = blocks.near(x, settings.radius, near);
    const double per_radius = 1 / settings.radius;
    for (int i = 0; i < count; ++i) {
      const ParticleGroup& group = blocks.group(near[i]);
      const Lanes ex = (x.x() - group.x) * per_radius;
      const Lanes ey = (x.y() - group.y) * per_radius;
      const Lanes ez = (x.z() - group.z) * per_radius;
      const Lanes u = 1 - (ex * ex + ey * ey + ez * ez);
      const LaneMask inside = u > 0;
      visit(group, ex, ey, ez, u, inside);
    }
  }

  FieldSettings settings;
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  ParticleBlocks blocks;
};

MetaballField::MetaballField(std::vector<Vec3> positions, std::vector<Vec3> velocities, FieldSettings settings)
    : impl_(std::make_unique<Impl>(std::move(positions), std::move(velocities), settings)) {}
MetaballField::~MetaballField() = default;
MetaballField::MetaballField(MetaballField&&) noexcept = default;
MetaballField& MetaballField::operator=(MetaballField&&) noexcept = default;

double MetaballField::value(const Vec3& x) const {
  const Lanes zero{};
  Lanes sum{};
  impl_->for_each_group(x, [&](const ParticleGroup&, const Lanes&, const Lanes&, const Lanes&, const Lanes& u,
                               const LaneMask& inside) { sum += inside ? u * u * u : zero; });
  return impl_->settings.weight * lane_sum(sum) - impl_->settings.threshold;
}

double MetaballField::value(const Vec3& x, Vec3& gradient) const {
  const Lanes zero{};
  Lanes sum{}, gx{}, gy{}, gz{};
  impl_->for_each_group(x, [&](const ParticleGroup&, const Lanes& ex, const Lanes& ey, const Lanes& ez, const Lanes& u,
                               const LaneMask& inside) {
    const Lanes u2 = inside ? u * u : zero;
    sum += inside ? u2 * u : zero;
    gx += inside ? u2 * ex : zero;
    gy += inside ? u2 * ey : zero;
    gz += inside ? u2 * ez : zero;
  });
  const FieldSettings& settings = impl_->settings;
  gradient = -6 * settings.weight / settings.radius * Vec3(lane_sum(gx), lane_sum(gy), lane_sum(gz));
  return settings.weight * lane_sum(sum) - settings.threshold;
}

Jet MetaballField::jet(const Vec3& x) const {
  constexpr int capacity = 32;
  std::array<NeighborLanes, capacity> lanes;
  int count = 0;
  const Lanes zero{};
  LaneMask neighbors{};
  MetaballSums sums;
  const bool moving = !impl_->velocities.empty();
  impl_->for_each_group(x, [&](const ParticleGroup& group, const Lanes& ex, const Lanes& ey, const Lanes& ez,
                               const Lanes& u, const LaneMask& inside) {
    if (count == capacity) {
      sums.add(lanes.data(), count, moving);
      count = 0;
    }
    NeighborLanes& next = lanes[count];
    next.ex = inside ? ex : zero;
    next.ey = inside ? ey : zero;
    next.ez = inside ? ez : zero;
    next.u = inside ? u : zero;
    next.vx = group.vx;
    next.vy = group.vy;
    next.vz = group.vz;
    neighbors -= inside;                          // a lane of a mask is 0 or -1
    count += static_cast<int>(any_lane(inside));  // without a branch, which could not be foretold
  });
  sums.add(lanes.data(), count, moving);
  Jet jet = sums.jet(impl_->settings);
  jet.neighbors = static_cast<int>(neighbors[0] + neighbors[1] + neighbors[2] + neighbors[3]);
  return jet;
}

KernelMoments MetaballField::moments(const Vec3& x) const {
  const Lanes zero{};
  std::array<Lanes, 3> gradient{};
  std::array<Lanes, 6> u2_ee{}, u_ee{};
  std::array<Lanes, 10> u_eee{};
  std::array<Lanes, 15> eeee{};
  impl_->for_each_group(x, [&](const ParticleGroup&, const Lanes& ex, const Lanes& ey, const Lanes& ez, const Lanes& u,
                               const LaneMask& inside) {
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
  KernelMoments moments;
  const auto sum = [](const auto& lanes, auto& sums) {
    for (std::size_t i = 0; i < lanes.size(); ++i) sums[i] = lane_sum(lanes[i]);
  };
  sum(u2_ee, moments.u2_ee);
  sum(u_ee, moments.u_ee);
  sum(u_eee, moments.u_eee);
  sum(eeee, moments.eeee);
  for (int a = 0; a < 3; ++a) moments.gradient[a] = -6 * lane_sum(gradient[a]);
  return moments;
}

const FieldSettings& MetaballField::settings() const { return impl_->settings; }
const std::vector<Vec3>& MetaballField::positions() const { return impl_->positions; }
const std::vector<Vec3>& MetaballField::velocities() const { return impl_->velocities; }

void MetaballField::neighbors(const Vec3& x, double radius, std::vector<int>& found) const {
  found.clear();
  if (!(radius > 0)) return;
  std::vector<int>& near = group_scratch();
  const int count = impl_->blocks.near(x, radius, near);
  for (int i = 0; i < count; ++i) {
    for (int lane = 0; lane < lane_count; ++lane) {
      const int particle = impl_->blocks.particle(near[i], lane);
      if (particle >= 0 && (impl_->positions[particle] - x).squaredNorm() < radius * radius) found.push_back(particle);
    }
  }
  std::sort(found.begin(), found.end());
}

}  // namespace flowskin::tracking
