// A disc that pours a jet of fluid, layer after layer.
#pragma once

#include <cstdint>
#include <vector>

#include "sph/solver.h"

namespace flowskin::sph {

/// The running state of an Emitter. Layer k, a square lattice in the disc, passes the disc at start + k spacing /
/// speed, whatever the time steps are. In the first 1.5 spacings behind the disc the jet keeps its speed, as in a
/// nozzle.
class JetEmitter {
 public:
  /// @throws SettingsError where the emitter is impossible; `name` says which one it is
  JetEmitter(const Emitter& emitter, double spacing, const std::string& name);

  struct Particle {
    Vec3 position, rest_position;
  };
  /// Appends the particles of the layers that pass the disc up to and including `time`, at their places at `time`.
  /// Their rest position is where they would have been at time 0 in an endless rigid jet: birth place - velocity *
  /// birth time.
  void pour(double time, std::vector<Particle>& particles);

  const std::string& fluid() const { return emitter_.fluid; }
  const Vec3& velocity() const { return velocity_; }
  std::size_t layer_size() const { return offsets_.size(); }
  /// Whether a point lies in the nozzle, where fluid keeps the jet's velocity.
  bool in_nozzle(const Vec3& p, double time) const;
  /// Birth time of the next layer (s); infinite when the emitter is done.
  double next_time() const;

  /// What changes while it pours.
  template <class Archive>
  void visit(Archive& archive) {
    archive(layer_);
  }

 private:
  Emitter emitter_;
  double spacing_;
  Vec3 velocity_;
  std::vector<Vec3> offsets_;  // of a layer's particles from the disc's centre
  std::uint64_t layer_ = 0;
};

}  // namespace flowskin::sph
