#include "tools/pipeline/comparison_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/render/labels.h"
#include "tools/render/video.h"

namespace flowskin::tools {
namespace {

constexpr int kTileWidth = 480;  // pixels, at most
constexpr int kSheetColumns = 6, kSheetPictureWidth = 320;
constexpr Color kPaper{255, 255, 255}, kInk{52, 56, 64};

int even(double value) { return std::max(2, 2 * int(std::lround(value / 2))); }

scenes::RenderSpec tile_settings(scenes::RenderSpec render) {
  const double ratio = double(render.height) / render.width;
  render.width = even(std::min(render.width, kTileWidth));
  render.height = even(render.width * ratio);
  return render;
}

std::vector<int> sheet_frames(int frames) {
  std::vector<int> chosen;
  for (int column = 0; column < kSheetColumns; ++column) {
    const int frame = int(std::lround(double(column) * frames / (kSheetColumns - 1)));
    if (chosen.empty() || frame != chosen.back()) chosen.push_back(frame);
  }
  return chosen;
}

}  // namespace

Image label_tiles(const std::vector<Image>& tiles, const std::vector<std::string>& labels) {
  if (tiles.empty()) return {};
  const int columns = int(std::ceil(std::sqrt(double(tiles.size())) - 1e-9));
  const int rows = (int(tiles.size()) + columns - 1) / columns;
  const int width = tiles.front().width, height = tiles.front().height;
  const int text = std::max(8, width / 32), strip = even(2.2 * text), gap = even(width / 80.0);
  Image sheet;
  sheet.width = columns * width + (columns - 1) * gap;
  sheet.height = rows * (height + strip);
  sheet.width += sheet.width % 2;
  sheet.height += sheet.height % 2;
  sheet.pixels.assign(std::size_t(sheet.width) * std::size_t(sheet.height), kPaper);
  for (int i = 0; i < int(tiles.size()); ++i) {
    const int left = i % columns * (width + gap), top = i / columns * (height + strip);
    for (int y = 0; y < height; ++y)
      std::copy_n(&tiles[std::size_t(i)].at(0, y), width, &sheet.at(left, top + strip + y));
    draw_text(sheet, left + 0.5 * text, top + 0.5 * (strip + text), text, labels[std::size_t(i)], kInk);
  }
  return sheet;
}

ComparisonPictures::ComparisonPictures(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture,
                                       const sph::Box& fluid, std::vector<std::string> methods)
    : directory_(directory),
      frame_rate_(scene.frame_rate),
      methods_(std::move(methods)),
      renderer_(tile_settings(scene.render), scene.boundaries, texture, fluid) {
  for (const int frame : sheet_frames(scene.frames)) sheet_tiles_[frame];
}

void ComparisonPictures::draw(int frame, const std::vector<SurfaceFrame>& surfaces, const ParticleFrame& particles) {
  std::vector<Image> tiles;
  for (const SurfaceFrame& surface : surfaces) tiles.push_back(renderer_.draw(surface));
  tiles.push_back(renderer_.draw(particles));
  std::vector<std::string> labels = methods_;
  labels.push_back(fmt::format("particles   {:.2f} s", frame / frame_rate_));
  write_png(directory_.compare_image(frame), label_tiles(tiles, labels));
  const auto kept = sheet_tiles_.find(frame);
  if (kept != sheet_tiles_.end()) kept->second = std::move(tiles);
}

void ComparisonPictures::finish(bool video, const std::function<void(const std::string&)>& report) const {
  std::vector<std::vector<Image>> rows(methods_.size() + 1);
  std::vector<std::string> row_labels = methods_, column_labels;
  row_labels.emplace_back("particles");
  for (const auto& [frame, tiles] : sheet_tiles_) {
    if (tiles.empty()) continue;
    column_labels.push_back(fmt::format("{:.2f} s", frame / frame_rate_));
    for (std::size_t i = 0; i < tiles.size(); ++i) rows[i].push_back(tiles[i]);
  }
  if (column_labels.empty()) return;
  write_png(directory_.compare_sheet(), contact_sheet(rows, row_labels, column_labels, kSheetPictureWidth));
  if (!video || !have_ffmpeg()) return;
  encode_video(directory_.image_folder() / "compare_%04d.png", frame_rate_, directory_.compare_video());
  report("wrote " + directory_.compare_video().string());
}

}  // namespace flowskin::tools
