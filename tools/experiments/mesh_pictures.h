// Pictures of carried meshes: textured or coloured by error, with the mesh's edges drawn on top.
#pragma once

#include <vector>

#include "scenes/scene.h"
#include "tools/textures/image.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tools {

/// The mesh with the scene's texture, camera and size, and its edges as thin dark lines.
/// `mesh.rest_positions` say where the texture was fixed at the start.
Image textured_picture(const scenes::Scene& scene, const tracking::SurfaceMesh& mesh);

/// The same coloured by `errors` (one a vertex): from blue (0) over white to red (`largest` and more).
Image error_picture(const scenes::Scene& scene, const tracking::SurfaceMesh& mesh, const std::vector<double>& errors,
                    double largest);

}  // namespace flowskin::tools
