#include "sph/jet_emitter.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace flowskin::sph {

namespace {

constexpr double nozzle_length = 1.5;  // in spacings

// Square lattice in a disc; of the lattices with a point or a cell centre in the middle, the one closer to the disc's
// area.
std::vector<Vec3> disc_lattice(const Emitter& emitter, const Vec3& axis, double spacing) {
  const Vec3 helper = std::abs(axis.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 u = (helper - helper.dot(axis) * axis).normalized(), v = axis.cross(u);
  const double wanted = M_PI * emitter.radius * emitter.radius / (spacing * spacing);
  std::vector<Vec3> best;
  for (const double shift : {0.0, 0.5}) {
    std::vector<Vec3> points;
    const int reach = static_cast<int>(std::ceil(emitter.radius / spacing)) + 1;
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        const Vec3 p = spacing * ((i + shift) * u + (j + shift) * v);
        if (p.norm() <= emitter.radius) points.push_back(p);
      }
    }
    const auto miss = [&](const std::vector<Vec3>& p) { return std::abs(static_cast<double>(p.size()) - wanted); };
    if (best.empty() || miss(points) < miss(best)) best = points;
  }
  return best;
}

}  // namespace

JetEmitter::JetEmitter(const Emitter& emitter, double spacing, const std::string& name)
    : emitter_(emitter), spacing_(spacing) {
  if (!(emitter.radius > 0)) throw SettingsError(name + ": its radius must be greater than 0");
  if (!(emitter.speed > 0)) throw SettingsError(name + ": its speed must be greater than 0");
  if (!(emitter.direction.norm() > 0)) throw SettingsError(name + ": its direction must not be zero");
  if (!(emitter.stop > emitter.start) || !(emitter.start >= 0)) {
    throw SettingsError(name + ": it must start at 0 s or later and stop after its start");
  }
  const Vec3 axis = emitter.direction.normalized();
  velocity_ = emitter.speed * axis;
  offsets_ = disc_lattice(emitter, axis, spacing);
}

double JetEmitter::next_time() const {
  const double time = emitter_.start + static_cast<double>(layer_) * spacing_ / emitter_.speed;
  return time < emitter_.stop ? time : std::numeric_limits<double>::infinity();
}

void JetEmitter::pour(double time, std::vector<Particle>& particles) {
  for (double birth = next_time(); birth <= time; birth = next_time()) {
    for (const Vec3& offset : offsets_) {
      const Vec3 birth_place = emitter_.center + offset;
      particles.push_back({birth_place + (time - birth) * velocity_, birth_place - birth * velocity_});
    }
    ++layer_;
  }
}

bool JetEmitter::in_nozzle(const Vec3& p, double time) const {
  if (time < emitter_.start || time >= emitter_.stop) return false;
  const Vec3 d = p - emitter_.center;
  const Vec3 axis = velocity_ / emitter_.speed;
  const double along = d.dot(axis);
  if (along < 0 || along > nozzle_length * spacing_) return false;
  return (d - along * axis).norm() <= emitter_.radius + 0.25 * spacing_;
}

}  // namespace flowskin::sph
