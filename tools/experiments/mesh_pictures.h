// Pictures of carried meshes: textured or coloured by error, with the mesh's edges drawn on top.
#pragma once

#include <memory>
#include <vector>

#include "scenes/scene.h"
#include "tools/textures/image.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tools {

/// Draws meshes of one scene, whose camera must have a position.
class MeshPainter {
 public:
  /// `start` says where the body is: light and ground are made for it.
  MeshPainter(const scenes::Scene& scene, const tracking::SurfaceMesh& start);
  ~MeshPainter();

  /// With the scene's texture. `mesh.rest_positions` say where the texture was fixed at the start.
  Image textured(const tracking::SurfaceMesh& mesh) const;
  /// Coloured by `errors` (one per vertex): from blue (0) over white to red (`largest` and more).
  Image colored(const tracking::SurfaceMesh& mesh, const std::vector<double>& errors, double largest) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowskin::tools
