// Tables of parts put together.
#pragma once

#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Appends the particles of another part of the same moment. Columns that only some parts have become faults; particles
/// that ParaView marks as copies of another part's (vtkGhostType) are left out.
void append_part(ParticleTable& whole, ParticleTable part);

}  // namespace flowskin::scenes
