// The volume of a surface that lies outside the walls.
#pragma once

#include <memory>
#include <vector>

#include "scenes/scene.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tools {

/// The closed walls of a scene. The surface of fluid that lies on a wall runs up to half a spacing within it
/// (docs/field.md#walls), so a thin film has a larger volume than its fluid.
class WallSolids {
 public:
  explicit WallSolids(const scenes::Scene& scene);
  ~WallSolids();
  WallSolids(WallSolids&&) noexcept;

  /// Volume of the mesh (m^3) once each vertex less than a spacing within a closed wall is put onto its surface; exact
  /// for flat walls. Open sheets and hollow walls have no inside. @param time of the walls (s)
  double volume_outside(const tracking::SurfaceMesh& mesh, double time) const;

 private:
  struct Solid;
  double spacing_ = 0;
  std::vector<std::unique_ptr<Solid>> solids_;
};

}  // namespace flowskin::tools
