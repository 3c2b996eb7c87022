// How a wall moves: by keyframes.
#pragma once

#include "common/keyframe_motion.h"
#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

using flowskin::Keyframe;
using flowskin::Pose;
using BoundaryMotion = flowskin::KeyframeMotion;

/// The mesh at a time.
TriangleMesh placed(const TriangleMesh& mesh, const BoundaryMotion& motion, double time);

}  // namespace flowskin::sph
