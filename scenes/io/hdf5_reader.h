// Reads particles from HDF5 files: of PySPH, H5Part, Gadget, VTKHDF, and plain arrays by their usual names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Whether the bytes begin as an HDF5 file does.
bool is_hdf5(std::string_view bytes);

/// One table for each time step. The particles are the arrays of the one group that holds places (named_arrays.h); of
/// several that are numbered as steps (Step#0, Step#1, ...) each is a step; of other groups the one called fluid, or
/// gas (PartType0), counts. @param name stands for the file in messages
/// @throws InputError where there are no particles, or several groups of them
std::vector<ParticleTable> parse_hdf5(std::string_view bytes, const std::string& name);

}  // namespace flowskin::scenes
