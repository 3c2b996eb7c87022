// What frames.csv says of a tracked surface.
#pragma once

#include "tools/report/frames_csv.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// Fills in the columns that are functions of the mesh and the particles beneath it; among them a comparison with a
/// fresh raw extraction of the same field at the same edge length.
void describe_surface(const tracking::SurfaceMesh& mesh, const tracking::Particles& particles,
                      const tracking::TrackerSettings& settings, FrameRow& row);

}  // namespace flowskin::tools
