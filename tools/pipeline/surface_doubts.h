// What makes one doubt that a surface is that of the fluid, and why there is none.
#pragma once

#include <string>
#include <vector>

#include "tools/report/frames_csv.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tools {

/// One sentence each where the surface holds less than half or more than twice the particles' volume, or falls into
/// more pieces than a particle in a hundred.
/// @param particles of the spacing (m)
std::vector<std::string> surface_doubts(const tracking::SurfaceMesh& mesh, std::size_t particles, double spacing);

/// Frames without a surface, in a sentence; empty where all have one.
std::string empty_frames(const std::vector<FrameRow>& rows);

/// Why no frame has a surface.
/// @param positions of particles in some frame that has the most
std::string why_no_surface(const std::vector<FrameRow>& rows, const std::vector<Vec3>& positions, double spacing);

}  // namespace flowskin::tools
