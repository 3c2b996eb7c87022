// What the program's parts say of frames, colours and small vectors, by short names.
#pragma once

#include "scenes/io/frames.h"

namespace flowskin::tools {

using scenes::Color;
using scenes::ParticleFrame;
using scenes::SurfaceFrame;
using scenes::Vec2f;
using Vec3f = Eigen::Vector3f;

}  // namespace flowskin::tools
