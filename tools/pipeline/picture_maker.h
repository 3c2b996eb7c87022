// Pictures of the frames of a run, and from them the videos and the contact sheet.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/pipeline/run_directory.h"
#include "tools/render/renderer.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

/// Draws frames into images/.
class PictureMaker {
 public:
  /// `fluid` is the box of the particles at the start (m), for the automatic camera.
  PictureMaker(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture, const sph::Box& fluid);

  void draw(int frame, const SurfaceFrame& surface) const;
  void draw(int frame, const ParticleFrame& particles) const;

 private:
  const RunDirectory& directory_;
  Renderer renderer_;
};

/// contact_sheet.png: the surface above the particles at six times, from the pictures in images/.
void make_contact_sheet(const RunDirectory& directory, double frame_rate);

/// surface.mp4 and particles.mp4 from the pictures in images/; `report` gets a line about what was made or why not.
void make_videos(const RunDirectory& directory, double frame_rate,
                 const std::function<void(const std::string&)>& report);

}  // namespace flowskin::tools
