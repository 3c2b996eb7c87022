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
constexpr int kComparedColumns = 6, kComparedPictureWidth = 320;
constexpr Color kPaper{255, 255, 255}, kLabelInk{52, 56, 64};

int even(double value) { return std::max(2, 2 * int(std::lround(value / 2))); }

scenes::RenderSpec tile_settings(scenes::RenderSpec render) {
  const double ratio = double(render.height) / render.width;
  render.width = even(std::min(render.width, kTileWidth));
  render.height = even(render.width * ratio);
  return render;
}

std::vector<int> sheet_frames(int frames) {
  std::vector<int> chosen;
  for (int column = 0; column < kComparedColumns; ++column) {
    const int frame = int(std::lround(double(column) * frames / (kComparedColumns - 1)));
    if (chosen.empty() || frame != chosen.back()) chosen.push_back(frame);
  }
  return chosen;
}

/// Where the pictures of a sheet are, each with its label above it.
struct Grid {
  int columns, rows, width, height, text, strip, gap;

  Grid(std::size_t count, int tile_width, int tile_height)
      : columns(std::max(1, int(std::ceil(std::sqrt(double(count)) - 1e-9)))),
        rows((int(count) + columns - 1) / columns),
        width(tile_width),
        height(tile_height),
        text(std::max(8, width / 32)),
        strip(even(2.2 * text)),
        gap(even(width / 80.0)) {}
  static int up_to_even(int size) { return size + size % 2; }
  int sheet_width() const { return up_to_even(columns * width + (columns - 1) * gap); }
  int sheet_height() const { return up_to_even(rows * (height + strip)); }
  /// Of the picture itself, below its label.
  std::pair<int, int> corner(int i) const {
    return {i % columns * (width + gap), i / columns * (height + strip) + strip};
  }
};

}  // namespace

Image label_tiles(const std::vector<Image>& tiles, const std::vector<std::string>& labels) {
  if (tiles.empty()) return {};
  const Grid grid(tiles.size(), tiles.front().width, tiles.front().height);
  Image sheet;
  sheet.width = grid.sheet_width();
  sheet.height = grid.sheet_height();
  sheet.pixels.assign(std::size_t(sheet.width) * std::size_t(sheet.height), kPaper);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto [left, top] = grid.corner(int(i));
    for (int y = 0; y < grid.height; ++y) std::copy_n(&tiles[i].at(0, y), grid.width, &sheet.at(left, top + y));
    draw_text(sheet, left + 0.5 * grid.text, top - grid.strip + 0.5 * (grid.strip + grid.text), grid.text, labels[i],
              kLabelInk);
  }
  return sheet;
}

std::vector<Image> cut_tiles(const Image& sheet, std::size_t count, int width, int height) {
  const Grid grid(count, width, height);
  if (sheet.width != grid.sheet_width() || sheet.height != grid.sheet_height()) return {};
  std::vector<Image> tiles;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [left, top] = grid.corner(int(i));
    Image& tile = tiles.emplace_back();
    tile.width = width;
    tile.height = height;
    for (int y = 0; y < height; ++y)
      tile.pixels.insert(tile.pixels.end(), &sheet.at(left, top + y), &sheet.at(left, top + y) + width);
  }
  return tiles;
}

ComparisonPictures::ComparisonPictures(const RunDirectory& directory, const scenes::Scene& scene, const Image& texture,
                                       const sph::Box& fluid, std::vector<std::string> methods)
    : directory_(directory),
      frame_rate_(scene.frame_rate),
      methods_(std::move(methods)),
      tile_(tile_settings(scene.render)),
      renderer_(tile_, scene.boundaries, texture, fluid),
      sheet_frames_(sheet_frames(scene.frames)) {}

void ComparisonPictures::draw(int frame, const std::vector<SurfaceFrame>& surfaces,
                              const ParticleFrame& particles) const {
  std::vector<Image> tiles;
  for (const SurfaceFrame& surface : surfaces) tiles.push_back(renderer_.draw(surface));
  tiles.push_back(renderer_.draw(particles));
  std::vector<std::string> labels = methods_;
  labels.push_back(fmt::format("particles   {:.2f} s", frame / frame_rate_));
  write_png(directory_.compare_image(frame), label_tiles(tiles, labels));
}

void ComparisonPictures::finish(bool video, const std::function<void(const std::string&)>& report) const {
  std::vector<std::vector<Image>> rows(methods_.size() + 1);
  std::vector<std::string> row_labels = methods_, column_labels;
  row_labels.emplace_back("particles");
  for (const int frame : sheet_frames_) {
    if (!std::filesystem::exists(directory_.compare_image(frame))) continue;
    const std::vector<Image> tiles =
        cut_tiles(read_image(directory_.compare_image(frame)), rows.size(), tile_.width, tile_.height);
    if (tiles.empty()) continue;
    column_labels.push_back(fmt::format("{:.2f} s", frame / frame_rate_));
    for (std::size_t i = 0; i < tiles.size(); ++i) rows[i].push_back(tiles[i]);
  }
  if (column_labels.empty()) return;
  write_png(directory_.compare_sheet(), contact_sheet(rows, row_labels, column_labels, kComparedPictureWidth));
  if (!video || !have_ffmpeg()) return;
  encode_video(directory_.image_folder() / "compare_%04d.png", frame_rate_, directory_.compare_video());
  report("wrote " + directory_.compare_video().string());
}

}  // namespace flowskin::tools
