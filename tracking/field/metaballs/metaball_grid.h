// The field of particles on a grid.
#pragma once

#include <vector>

#include "tracking/extraction/sparse_grid.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tracking {

/// The metaball field [FMM13, Eq. 13] without walls: every particle adds its kernel to the nodes in its support. There
/// is at least one layer of nodes with the outside value, -T, around the supports.
/// @param shares factors of the particles' weights; empty: 1 each
/// @throws std::invalid_argument where the particles spread over more than two million blocks along an axis, or where
/// spacing, radius or threshold are not positive.
SparseGrid grid_of_particles(const std::vector<Vec3>& positions, const FieldSettings& settings, double spacing,
                             const std::vector<double>& shares = {});

}  // namespace flowskin::tracking
