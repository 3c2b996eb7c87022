#include "scenes/sources/make_source.h"

#include "scenes/sources/prescribed_source.h"
#include "scenes/sources/recorded_source.h"
#include "scenes/sources/simulation_source.h"

namespace flowskin::scenes {

std::unique_ptr<ParticleSource> make_source(const Scene& scene) {
  switch (scene.particles.source) {
    case ParticlesSpec::Source::prescribed:
      return std::make_unique<PrescribedSource>(scene);
    case ParticlesSpec::Source::recorded:
      return std::make_unique<RecordedSource>(scene);
    case ParticlesSpec::Source::simulation:
      break;
  }
  return std::make_unique<SimulationSource>(scene);
}

}  // namespace flowskin::scenes
