// The field of particles on their paths, as one that moves.
#pragma once

#include <memory>

#include "tracking/advection/particle_paths.h"
#include "tracking/field/field_motion.h"

namespace flowskin::tracking {

/// Keeps a reference to the paths.
class ParticleMotion final : public FieldMotion {
 public:
  ParticleMotion(const ParticlePaths& paths, const FieldSettings& settings) : paths_(paths), settings_(settings) {}
  double begin_time() const override { return paths_.begin_time(); }
  double end_time() const override { return paths_.end_time(); }
  std::shared_ptr<const ImplicitField> field(double time) const override {
    return std::make_shared<const MetaballField>(paths_.field(time, settings_));
  }
  double longest_path() const override { return paths_.longest_path(); }

 private:
  const ParticlePaths& paths_;
  FieldSettings settings_;
};

}  // namespace flowskin::tracking
