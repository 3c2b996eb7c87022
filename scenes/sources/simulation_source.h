// Particles of the project's own solver.
#pragma once

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "sph/solver.h"

namespace flowskin::scenes {

class SimulationSource : public ParticleSource {
 public:
  /// @throws sph::SettingsError where the simulation cannot be set up, InputError where it blows up at the start.
  explicit SimulationSource(const Scene& scene);

  const ParticleState& state() const override { return state_; }
  /// @throws sph::BlowUpError
  void advance_to(double time) override;
  bool advance_towards(double time, const std::function<bool()>& stop) override;
  double spacing() const override { return solver_.settings().spacing; }
  SourceStatistics statistics() const override;
  std::vector<std::string> warnings() const override { return solver_.warnings(); }
  void save(StateWriter& writer) const override { solver_.save(writer); }
  void restore(StateReader& reader) override;
  const sph::Solver& solver() const { return solver_; }

 private:
  void take_state();

  sph::Solver solver_;
  tracking::Walls walls_;
  ParticleState state_;
};

}  // namespace flowskin::scenes
