// What a run says of itself at its start and at its end.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"
#include "tools/pipeline/frame_table.h"
#include "tools/pipeline/tracked_surface.h"
#include "tools/report/run_clock.h"

namespace flowskin::tools {

/// The scene, its particles and its surface (null: none is tracked), a line each.
std::vector<std::string> lines_at_start(const scenes::Scene& scene, const scenes::ParticleSource& source,
                                        const TrackedSurface* surface);

/// Where the time went, memory, and the worst of the run, a line each.
std::vector<std::string> lines_at_end(const scenes::Scene& scene, const scenes::ParticleSource& source,
                                      const TrackedSurface* surface, const FrameTable& table, const RunClock& clock);

}  // namespace flowskin::tools
