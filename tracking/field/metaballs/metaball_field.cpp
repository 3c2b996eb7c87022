#include "tracking/field/metaballs/metaball_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/number_text.h"
#include "tracking/field/metaballs/field_parts.h"

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
    throw std::invalid_argument("MetaballField: radius is " + number_text(settings.radius, 4) +
                                "; expected a positive length (m), see default_field_settings");
  }
  if (!positive(settings.weight) || !std::isfinite(settings.threshold)) {
    throw std::invalid_argument("MetaballField: weight is " + number_text(settings.weight, 4) + ", threshold is " +
                                number_text(settings.threshold, 4) + "; expected a positive and a finite number");
  }
  if (!velocities.empty() && velocities.size() != positions.size()) {
    throw std::invalid_argument("MetaballField: " + std::to_string(velocities.size()) + " velocities for " +
                                std::to_string(positions.size()) + " positions; expected as many, or none");
  }
  check_finite(positions, "position");
  check_finite(velocities, "velocity");
}

std::vector<FieldPart> single_part(std::vector<Vec3> positions, std::vector<Vec3> velocities) {
  std::vector<FieldPart> parts(1);
  parts.front().positions = std::move(positions);
  parts.front().velocities = std::move(velocities);
  return parts;
}

void append(std::vector<Vec3>&& from, std::vector<Vec3>& to) {
  if (to.empty()) {
    to = std::move(from);
  } else {
    to.insert(to.end(), from.begin(), from.end());
  }
}

}  // namespace

FieldSettings default_field_settings(double spacing, double radius_in_spacings) {
  if (!positive(spacing) || !positive(radius_in_spacings)) {
    throw std::invalid_argument("default_field_settings: spacing is " + number_text(spacing, 4) + ", radius is " +
                                number_text(radius_in_spacings, 4) + " spacings; expected positive numbers");
  }
  FieldSettings settings;
  settings.radius = radius_in_spacings * spacing;
  // Half of what the sum is on average deep inside: integral of (1 - r^2)^3 over the unit ball = 4 pi 16 / 315.
  settings.threshold = 0.5 * settings.weight * (64 * std::numbers::pi / 315) * std::pow(radius_in_spacings, 3);
  return settings;
}

MetaballField::Impl::Impl(std::vector<FieldPart> given, const FieldSettings& field_settings, FieldWalls given_walls)
    : settings(field_settings), per_square(1 / (settings.radius * settings.radius)), walls(std::move(given_walls)) {
  const bool some_move =
      std::any_of(given.begin(), given.end(), [](const FieldPart& p) { return !p.velocities.empty(); });
  const bool one_whole = given.size() == 1 && given.front().share == 1;
  for (FieldPart& part : given) {
    check(part.positions, part.velocities, settings);
    if (!(std::isfinite(part.share) && part.share >= 0 && std::isfinite(part.share_rate)))
      throw std::invalid_argument("MetaballField: the share of a part is " + number_text(part.share, 4) +
                                  ", its rate " + number_text(part.share_rate, 4) +
                                  "; expected a number that is not negative and a finite one");
    const std::size_t count = part.positions.size();
    parts.push_back({std::make_shared<const ParticleBlocks>(part.positions, part.velocities, settings.radius),
                     part.share, part.share_rate, static_cast<int>(positions.size())});
    if (some_move && part.velocities.empty()) part.velocities.assign(count, Vec3::Zero());
    if (!one_whole) shares.insert(shares.end(), count, part.share);
    append(std::move(part.positions), positions);
    append(std::move(part.velocities), velocities);
  }
  if (given.empty()) check({}, {}, settings);
  particle_parts = parts.size();
  for (const auto& wall : walls) parts.push_back({wall->blocks(), wall->share(), 0, 0});
}

void MetaballField::Impl::add_share(const MotionJet& jet, const Part& part, MotionJet& sum) {
  const double share = part.share, share_rate = part.share_rate;
  sum.moving_value += share * jet.moving_value;
  sum.gradient += share * jet.gradient;
  sum.hessian += share * jet.hessian;
  for (int axis = 0; axis < 3; ++axis) sum.third[axis] += share * jet.third[axis];
  sum.value_rate += share * jet.value_rate + share_rate * jet.moving_value;
  sum.gradient_rate += share * jet.gradient_rate + share_rate * jet.gradient;
  sum.hessian_rate += share * jet.hessian_rate + share_rate * jet.hessian;
  sum.neighbors += jet.neighbors;
}

MetaballField::MetaballField(std::vector<Vec3> positions, std::vector<Vec3> velocities, FieldSettings settings)
    : MetaballField(single_part(std::move(positions), std::move(velocities)), settings) {}
MetaballField::MetaballField(std::vector<FieldPart> parts, FieldSettings settings, FieldWalls walls)
    : impl_(std::make_unique<Impl>(std::move(parts), settings, std::move(walls))) {}
MetaballField::~MetaballField() = default;
MetaballField::MetaballField(MetaballField&&) noexcept = default;
MetaballField& MetaballField::operator=(MetaballField&&) noexcept = default;

double MetaballField::value(const Vec3& x) const { return impl_->value(x, impl_->looked_up(x)); }
double MetaballField::value(const Vec3& x, Vec3& gradient) const {
  return impl_->value(x, gradient, impl_->looked_up(x));
}
MotionJet MetaballField::motion_jet(const Vec3& x) const { return impl_->jet(x, impl_->looked_up(x)); }
KernelMoments MetaballField::moments(const Vec3& x) const { return impl_->moments(x, impl_->looked_up(x)); }

const FieldSettings& MetaballField::settings() const { return impl_->settings; }
const std::vector<Vec3>& MetaballField::positions() const { return impl_->positions; }
const std::vector<Vec3>& MetaballField::velocities() const { return impl_->velocities; }
const std::vector<double>& MetaballField::shares() const { return impl_->shares; }
const FieldWalls& MetaballField::walls() const { return impl_->walls; }

void MetaballField::neighbors(const Vec3& x, double reach, std::vector<int>& found) const {
  found.clear();
  if (!(reach > 0)) return;
  impl_->neighbors(x, reach, found,
                   [&](std::size_t part) { return impl_->parts[part].blocks->near(x, reach, Impl::scratch()); });
}

}  // namespace flowskin::tracking
