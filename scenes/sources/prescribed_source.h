// Particles that follow a prescribed motion: their paths are known, which makes them the ground truth of experiments.
#pragma once

#include "scenes/scene.h"
#include "scenes/sources/motion.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// Positions come from closed forms; for motions that have none from RK4 with a fixed step, counted from time 0, so
/// that they do not depend on the times asked for. Velocities are those of the analytic field.
class PrescribedSource : public ParticleSource {
 public:
  /// @throws InputError, sph::SettingsError where the scene gives no particles or an unknown motion.
  explicit PrescribedSource(const Scene& scene);

  const ParticleState& state() const override { return state_; }
  void advance_to(double time) override;
  double spacing() const override { return spacing_; }
  SourceStatistics statistics() const override;
  void save(StateWriter& writer) const override { const_cast<PrescribedSource*>(this)->visit(writer); }
  void restore(StateReader& reader) override;

 private:
  template <class Archive>
  void visit(Archive& archive) {
    archive.section("prescribed motion");
    archive(state_, grid_positions_, grid_step_);
  }
  /// Positions in the moving frame at `time`, in state_.
  void place_by_integration(double time);
  /// One step of RK4 (s) from a place at a time, in the moving frame.
  Vec3 integrated(const Vec3& position, double time, double step) const;

  Motion motion_;
  double spacing_;
  ParticleState state_;
  std::vector<Vec3> grid_positions_;  ///< At grid_step_ whole steps, in the moving frame: without closed form only.
  std::uint64_t grid_step_ = 0;
};

}  // namespace flowskin::scenes
