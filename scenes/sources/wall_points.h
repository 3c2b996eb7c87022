// The walls of a scene as its states hand them out.
#pragma once

#include "scenes/scene.h"
#include "tracking/particles.h"

namespace flowskin::scenes {

/// Points on the scene's walls, one spacing apart, and how they move. Empty where the scene has no walls, or none that
/// its surface is to know of (`tracking.wall_share` 0, or no surface at all). A source samples them once.
tracking::Walls sample_walls(const Scene& scene);

}  // namespace flowskin::scenes
