#include "sph/bodies/jet_emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

constexpr double nozzle_length = 1.5;         // in spacings
constexpr double least_distance = 0.6;        // in spacings: of new particles to others
constexpr double closing_compression = 0.03;  // six times the stagnation pressure of the fastest flow expected

}  // namespace

JetEmitter::JetEmitter(const Emitter& emitter, double spacing, const std::string& name)
    : emitter_(emitter), spacing_(spacing), outlet_(emitter, spacing, name) {
  if (!(emitter.speed > 0)) throw SettingsError(name + ": its speed must be greater than 0");
  if (!(emitter.stop > emitter.start) || !(emitter.start >= 0)) {
    throw SettingsError(name + ": it must start at 0 s or later and stop after its start");
  }
  velocity_ = emitter.speed * outlet_.axis();
  layer_distance_ = spacing * spacing * spacing * static_cast<double>(layer_size()) / outlet_.area();
  emitter_.mesh = {};
}

double JetEmitter::next_time() const {
  const double time = emitter_.start + delay_ + static_cast<double>(layer_) * layer_distance_ / emitter_.speed;
  const bool full = emitter_.max_particles > 0 && poured_ + layer_size() > emitter_.max_particles;
  return time < emitter_.stop && !full ? time : std::numeric_limits<double>::infinity();
}

void JetEmitter::collect(const Vec3& position, double compression, Surroundings& surroundings) const {
  const Vec3 d = position - outlet_.center();
  if (d.squaredNorm() > std::pow(outlet_.reach() + (nozzle_length + 1) * spacing_, 2)) return;
  surroundings.positions.push_back(position);
  if (!in_nozzle(position)) return;
  const auto count = static_cast<double>(++surroundings.in_nozzle);
  surroundings.compression += (compression - surroundings.compression) / count;
}

std::size_t JetEmitter::pour(double time, const Surroundings& surroundings, std::vector<Particle>& particles) {
  closed_ = surroundings.in_nozzle > 0 && surroundings.compression > closing_compression;
  if (closed_) {
    // Tries again after a quarter of a layer.
    const double pause = 0.25 * layer_distance_ / emitter_.speed;
    delay_ += pause * (std::floor((time - next_time()) / pause) + 1);
    return 0;
  }
  std::size_t empty = 0;
  for (double birth = next_time(); birth <= time; birth = next_time()) {
    const Vec3 rest_center = outlet_.center() - (birth - delay_) * velocity_;
    for (const Vec3& offset : outlet_.offsets()) {
      const Vec3 place = outlet_.center() + offset + (time - birth) * velocity_;
      const bool taken = std::any_of(
          surroundings.positions.begin(), surroundings.positions.end(),
          [&](const Vec3& other) { return (other - place).squaredNorm() < std::pow(least_distance * spacing_, 2); });
      if (taken) {
        ++empty;
      } else {
        particles.push_back({place, rest_center + offset});
        ++poured_;
      }
    }
    ++layer_;
  }
  return empty;
}

bool JetEmitter::in_nozzle(const Vec3& p) const {
  const double along = (p - outlet_.center()).dot(outlet_.axis());
  return along >= 0 && along <= nozzle_length * spacing_ && outlet_.contains(p, 0.25 * spacing_);
}

bool JetEmitter::in_nozzle(const Vec3& p, double time) const {
  return time >= emitter_.start && time < emitter_.stop && in_nozzle(p);
}

}  // namespace flowskin::sph
