// What the files hold that a run is made from.
#pragma once

#include <vector>

#include "scenes/scene.h"
#include "tools/pipeline/checkpoint.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

/// What is in the meshes and the texture that the scene names. Key frames of walls stand in the scene itself; recorded
/// particles are looked after by their source, which reads them on the way (RecordedSource::restore).
/// @param texture as read from the scene's file
std::vector<FileContent> input_files(const scenes::Scene& scene, const Image& texture);

}  // namespace flowskin::tools
