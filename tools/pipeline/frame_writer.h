// Writes the files of one frame after the other, in the formats that the scene asks for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/pipeline/run_directory.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

class FrameWriter {
 public:
  /// Name of the texture in surface/.
  static constexpr const char* kTextureFile = "texture.png";

  /// Writes the texture and the material that all frames share. @throws RunError
  FrameWriter(const RunDirectory& directory, const scenes::OutputSpec& formats, const Image& texture);

  /// @throws RunError; files are written whole or not at all.
  void write(int frame, const SurfaceFrame& surface);
  void write(int frame, const ParticleFrame& particles);

  template <class Archive>
  void visit(Archive& archive) {
    archive(surface_files_, particle_files_);
  }

 private:
  const RunDirectory& directory_;
  scenes::OutputSpec formats_;
  std::vector<std::pair<double, std::string>> surface_files_, particle_files_;  // of the ParaView collections
};

}  // namespace flowskin::tools
