#include "tracking/field/particle_field.h"

#include <stdexcept>

#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {

const ParticleField& particles_of(const ImplicitField& field, const std::string& who) {
  if (const ParticleField* particles = field.particles()) return *particles;
  throw std::invalid_argument(who + " needs particles, but this field is not made of any");
}

}  // namespace flowskin::tracking
