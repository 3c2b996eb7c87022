// Pictures of a comparison of velocity methods: all surfaces side by side, and the particles.
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

/// Pictures side by side in a grid, each below its label; missing places are white. The size is even, for videos.
Image label_tiles(const std::vector<Image>& tiles, const std::vector<std::string>& labels);
/// The pictures, all of this size, that label_tiles made this sheet of; none where the sheet has another size.
std::vector<Image> cut_tiles(const Image& sheet, std::size_t count, int width, int height);

/// Draws images/compare_NNNN.png, smaller pictures than those of the run itself.
class ComparisonPictures {
 public:
  /// `fluid` is the box of the particles at the start (m), for the automatic camera.
  ComparisonPictures(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture,
                     const sph::Box& fluid, std::vector<std::string> methods);

  /// `surfaces` in the order of the methods.
  void draw(int frame, const std::vector<SurfaceFrame>& surfaces, const ParticleFrame& particles) const;
  /// From the pictures in images/: compare_sheet.png and, where wanted and there is an ffmpeg, compare.mp4; `report`
  /// gets a line about what was made.
  void finish(bool video, const std::function<void(const std::string&)>& report) const;

 private:
  const RunDirectory& directory_;
  double frame_rate_;
  std::vector<std::string> methods_;
  scenes::RenderSpec tile_;
  Renderer renderer_;
  std::vector<int> sheet_frames_;
};

}  // namespace flowskin::tools
