// The walls of a scene as the tracker's field meets them.
#pragma once

#include "scenes/scene.h"
#include "tracking/field/metaball_field.h"

namespace flowskin::tools {

/// Points on the scene's walls, one spacing apart, that make the field `tracking.wall_share` times its threshold on a
/// bare wall; moving ones where they are at the time asked for. Empty where the scene has no walls or no such share.
tracking::WallsAt field_walls(const scenes::Scene& scene, const tracking::FieldSettings& settings);

}  // namespace flowskin::tools
