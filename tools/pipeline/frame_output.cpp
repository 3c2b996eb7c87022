#include "tools/pipeline/frame_output.h"

namespace flowskin::tools {

FrameOutput::FrameOutput(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture,
                         const sph::Box& fluid, StageClock& clock)
    : directory_(directory), scene_(scene), clock_(clock), writer_(directory, scene.output, texture) {
  if (scene.render.enabled) pictures_.emplace(directory, scene, texture, fluid);
}

void FrameOutput::write(int frame, const ParticleFrame& particles, const SurfaceFrame* surface) {
  clock_.time("writing", [&] {
    writer_.write(frame, particles);
    if (surface) writer_.write(frame, *surface);
  });
  if (!pictures_) return;
  clock_.time("pictures", [&] {
    pictures_->draw(frame, particles);
    if (surface) pictures_->draw(frame, *surface);
  });
}

void FrameOutput::finish(const std::function<void(const std::string&)>& report) {
  if (!pictures_) return;
  clock_.time("contact sheet", [&] { make_contact_sheet(directory_, scene_.frame_rate); });
  if (scene_.output.video) clock_.time("videos", [&] { make_videos(directory_, scene_.frame_rate, report); });
}

}  // namespace flowskin::tools
