#include "tracking/velocity/particle_velocities.h"

#include <stdexcept>

#include "tracking/field/particle_field.h"

namespace flowskin::tracking {

void require_particle_velocities(const ImplicitField& field, const std::string& method) {
  const ParticleField& particles = particles_of(field, "the velocity method \"" + method + "\"");
  if (particles.positions().empty() || !particles.velocities().empty()) return;
  throw std::invalid_argument("the velocity method \"" + method +
                              "\" needs particles with velocities; use \"affine\" for particles without");
}

}  // namespace flowskin::tracking
