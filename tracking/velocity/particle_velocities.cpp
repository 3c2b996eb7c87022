#include "tracking/velocity/particle_velocities.h"

#include <stdexcept>

namespace flowskin::tracking {

void require_particle_velocities(const MetaballField& field, const std::string& method) {
  if (field.positions().empty() || !field.velocities().empty()) return;
  throw std::invalid_argument("the velocity method \"" + method +
                              "\" needs particles with velocities; use \"affine\" for particles without");
}

}  // namespace flowskin::tracking
