// All files of the frames of a run: surfaces, particles, pictures, and at the end contact sheet and videos.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/pipeline/frame_writer.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/pipeline/run_directory.h"
#include "tools/report/stage_clock.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

class FrameOutput {
 public:
  /// @param fluid box of the particles at the start (m), for the automatic camera
  /// @param clock gets the time that all this takes
  FrameOutput(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture, const sph::Box& fluid,
              StageClock& clock);

  /// @param surface null where none is tracked. @throws RunError; files are written whole or not at all.
  void write(int frame, const ParticleFrame& particles, const SurfaceFrame* surface);
  /// `report` gets a line about what was made or why not.
  void finish(const std::function<void(const std::string&)>& report);

  template <class Archive>
  void visit(Archive& archive) {
    archive(writer_);
  }

 private:
  const RunDirectory& directory_;
  const scenes::Scene& scene_;
  StageClock& clock_;
  FrameWriter writer_;
  std::optional<PictureMaker> pictures_;
};

}  // namespace flowskin::tools
