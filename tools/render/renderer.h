// Ray traces frames with Embree.
#pragma once

#include <memory>
#include <vector>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

/// Draws the frames of one scene: walls, ground and light are built once; walls that move, anew for each time.
class Renderer {
 public:
  /// `texture` is what corner_uvs refer to. A camera whose position is all zero is placed to see the walls and `fluid`.
  Renderer(const scenes::RenderSpec& settings, const std::vector<scenes::BoundarySpec>& boundaries,
           const Image& texture, const sph::Box& fluid);
  ~Renderer();

  /// The surface in the style of the settings, with the walls where they are at the frame's time. The same bytes at any
  /// thread count.
  Image draw(const SurfaceFrame& frame) const;
  /// The particles as balls in their colours.
  Image draw(const ParticleFrame& frame) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowskin::tools
