// An outlet that pours a jet of fluid, layer after layer.
#pragma once

#include <cstdint>
#include <vector>

#include "sph/bodies/emitter_outlet.h"

namespace flowskin::sph {

/// The running state of an Emitter. Layer k, a lattice in the outlet, passes the outlet at start + k layer_distance() /
/// speed, whatever the time steps are; the layers' distance is such that the volume flow is area times speed. In the
/// first 1.5 spacings behind the outlet the jet keeps its speed, as in a nozzle.
///
/// An outlet against which fluid presses, so that the fluid in the nozzle is compressed by more than 3 % on average,
/// closes like a valve: the nozzle's fluid rests and nothing is poured until the pressure falls. Places of a layer
/// where other fluid is nearer than 0.6 spacings stay empty.
class JetEmitter {
 public:
  /// @throws SettingsError where the emitter is impossible; `name` says which one it is
  JetEmitter(const Emitter& emitter, double spacing, const std::string& name);

  struct Particle {
    Vec3 position, rest_position;
  };
  /// Fluid around the outlet: what collect() took.
  struct Surroundings {
    std::vector<Vec3> positions;  ///< m
    double compression = 0;       ///< Mean of rho / rho_0 - 1 in the nozzle.
    std::size_t in_nozzle = 0;
  };
  void collect(const Vec3& position, double compression, Surroundings& surroundings) const;
  /// Appends the particles of the layers that pass the outlet up to and including `time`, at their places at `time`,
  /// or closes the outlet for a while. Their rest position is where they would have been at time 0 in an endless rigid
  /// jet: birth place - velocity * birth time.
  /// @return places that stayed empty
  std::size_t pour(double time, const Surroundings& surroundings, std::vector<Particle>& particles);

  /// Leaves out the places of each layer for which `leaves(place)` holds, a place (m) lying a thousandth of a spacing
  /// before the outlet, so that an outlet flush with a wall is inside only where it pours into it. The flow through the
  /// other places stays the same.
  template <class Leaves>
  void leave_out(const Leaves& leaves) {
    const Vec3 from = outlet_.center() + 1e-3 * spacing_ * outlet_.axis();
    outlet_.leave_out([&](const Vec3& offset) { return leaves(Vec3(from + offset)); });
  }

  double start() const { return emitter_.start; }  ///< s
  const std::string& fluid() const { return emitter_.fluid; }
  /// Velocity of the fluid in the nozzle (m/s): zero while it is closed.
  Vec3 velocity() const { return closed_ ? Vec3::Zero().eval() : velocity_; }
  std::size_t layer_size() const { return outlet_.offsets().size(); }
  double layer_distance() const { return layer_distance_; }
  const EmitterOutlet& outlet() const { return outlet_; }
  /// Whether a point lies in the nozzle, where fluid keeps the jet's velocity.
  bool in_nozzle(const Vec3& p, double time) const;
  /// Time at which the next layer is due (s); infinite when the emitter is done.
  double next_time() const;

  /// What changes while it pours.
  template <class Archive>
  void visit(Archive& archive) {
    archive(layer_, poured_, delay_, closed_);
  }

 private:
  bool in_nozzle(const Vec3& p) const;

  Emitter emitter_;
  double spacing_;
  EmitterOutlet outlet_;
  double layer_distance_ = 0;
  Vec3 velocity_;
  std::uint64_t layer_ = 0, poured_ = 0;  // layers, particles
  double delay_ = 0;                      // s: how long the outlet has been closed
  bool closed_ = false;
};

}  // namespace flowskin::sph
