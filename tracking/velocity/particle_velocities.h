// What methods that use the particles' own velocities say to a field without any.
#pragma once

#include <string>

#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {

/// @throws std::invalid_argument where the field has particles but no velocities.
void require_particle_velocities(const ImplicitField& field, const std::string& method);

}  // namespace flowskin::tracking
