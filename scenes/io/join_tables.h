// Tables of parts put together, and one table taken apart into time steps.
#pragma once

#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Appends the particles of another part of the same moment. Columns that only some parts have become faults; particles
/// that ParaView marks as copies of another part's (vtkGhostType) are left out.
void append_part(ParticleTable& whole, ParticleTable part);

/// The time steps of a table with a column Time or TimeStep, as ParaView writes many steps into one: rows of one value
/// are one step, in ascending order. One table where the column has one value, or about as many as there are rows (then
/// it is no time of steps).
std::vector<ParticleTable> steps_by_time_column(ParticleTable table);

}  // namespace flowskin::scenes
