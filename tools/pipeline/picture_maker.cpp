#include "tools/pipeline/picture_maker.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/render/video.h"

namespace flowskin::tools {

namespace {
constexpr int kSheetColumns = 6;
constexpr int kSheetPictureWidth = 480;  // pixels
}  // namespace

PictureMaker::PictureMaker(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture,
                           const sph::Box& fluid)
    : directory_(directory), renderer_(scene.render, scene.boundaries, texture, fluid) {}

void PictureMaker::draw(int frame, const SurfaceFrame& surface) const {
  write_png(directory_.surface_image(frame), renderer_.draw(surface));
}

void PictureMaker::draw(int frame, const ParticleFrame& particles) const {
  write_png(directory_.particle_image(frame), renderer_.draw(particles));
}

void make_contact_sheet(const RunDirectory& directory, double frame_rate) {
  const auto surface_frames = RunDirectory::frames_in(directory.image_folder(), "frame_", ".png");
  const auto particle_frames = RunDirectory::frames_in(directory.image_folder(), "particles_", ".png");
  const auto& frames = surface_frames.empty() ? particle_frames : surface_frames;
  if (frames.empty()) return;
  std::vector<int> chosen;
  for (int column = 0; column < kSheetColumns; ++column) {
    const auto index = std::size_t(std::lround(double(column) * double(frames.size() - 1) / (kSheetColumns - 1)));
    if (chosen.empty() || frames[index] != chosen.back()) chosen.push_back(frames[index]);
  }
  std::vector<std::vector<Image>> rows;
  std::vector<std::string> row_labels, column_labels;
  for (int frame : chosen) column_labels.push_back(fmt::format("{:.2f} s", frame / frame_rate));
  const auto add_row = [&](const char* label, auto image_of) {
    std::vector<Image> row;
    for (int frame : chosen)
      if (std::filesystem::exists(image_of(frame))) row.push_back(read_image(image_of(frame)));
    if (row.size() != chosen.size()) return;  // this row was not drawn, or not at these frames
    rows.push_back(std::move(row));
    row_labels.emplace_back(label);
  };
  add_row("surface", [&](int frame) { return directory.surface_image(frame); });
  add_row("particles", [&](int frame) { return directory.particle_image(frame); });
  write_png(directory.contact_sheet(), contact_sheet(rows, row_labels, column_labels, kSheetPictureWidth));
}

void make_videos(const RunDirectory& directory, double frame_rate,
                 const std::function<void(const std::string&)>& report) {
  if (!have_ffmpeg()) {
    report(
        "no videos: there is no ffmpeg on the path (apt-get install ffmpeg); the pictures are in images/, and "
        "`flowskin render` makes the videos later");
    return;
  }
  const auto encode = [&](const char* prefix, const std::filesystem::path& video) {
    const std::vector<int> frames = RunDirectory::frames_in(directory.image_folder(), prefix, ".png");
    if (frames.empty()) return;
    // A run that went on after one without pictures has those of its own frames only.
    if (std::size_t(frames.back()) + 1 != frames.size()) {
      report(fmt::format(
          "no {}: {} has {} pictures of {} frames; `flowskin render {}` draws them all and makes the videos",
          video.filename().string(), directory.image_folder().string(), frames.size(), frames.back() + 1,
          directory.root().string()));
      return;
    }
    encode_video(directory.image_folder() / (std::string(prefix) + "%04d.png"), frame_rate, video);
    report("wrote " + video.string());
  };
  encode("frame_", directory.surface_video());
  encode("particles_", directory.particle_video());
}

}  // namespace flowskin::tools
