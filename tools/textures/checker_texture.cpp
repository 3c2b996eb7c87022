// The UV grid: 8 by 8 coloured squares, A1 at the lower left, letters upwards (v), numbers to the right (u).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/textures/image.h"
#include "tools/textures/perceptual_color.h"
#include "tools/textures/stroke_font.h"

namespace flowskin::tools {
namespace {

constexpr int kCells = 8;
constexpr float kLabelHeight = 0.40F;        ///< in cells
constexpr float kLabelGap = 0.16F;           ///< between the two characters, in cells
constexpr float kPenRadius = 0.049F;         ///< in cells
constexpr float kCheckerLineWidth = 0.014F;  ///< half the width of the grid's lines, in cells

struct CellStyle {
  Vec3 fill, label;  ///< linear light
};

/// Hue runs once round the circle along u, rows alternate by half a cell's hue, and colours are strongest in the middle
/// of the tile: so the grid goes on across its edges, and no two cells are alike.
CellStyle cell_style(int column, int row) {
  const double hue = (column + 0.5) / kCells + (row % 2) * 0.5 / kCells + 0.02;
  const bool is_light = (column + row) % 2 == 0;
  const double up =
      0.5 - 0.5 * std::cos(2 * std::numbers::pi * (row + 0.5) / kCells);  // 0 at the tile's edge, 1 in its middle
  if (is_light) return {linear_from_oklch(0.90 - 0.05 * up, 0.05 + 0.05 * up, hue), linear_from_oklch(0.42, 0.10, hue)};
  return {linear_from_oklch(0.64 - 0.10 * up, 0.14, hue), linear_from_oklch(0.96, 0.02, hue)};
}

/// A cell's label with the place of its characters.
struct Label {
  StrokeGlyph first, second;
  Vec2f first_corner, second_corner;  ///< lower left corners, in cells

  Label(int column, int row)
      : first(stroke_glyph(static_cast<char>('A' + row))), second(stroke_glyph(static_cast<char>('1' + column))) {
    const float width = (first.width + second.width) * kLabelHeight + kLabelGap;
    first_corner = Vec2f(0.5F - width / 2, 0.5F - kLabelHeight / 2);
    second_corner = first_corner + Vec2f(first.width * kLabelHeight + kLabelGap, 0);
  }

  /// Distance to the nearest stroke, in cells; a large number where no pen can reach.
  float distance(const Vec2f& point) const {
    const Vec2f from_middle = (point - Vec2f(0.5F, 0.5F)).cwiseAbs();
    if (from_middle.y() > kLabelHeight / 2 + 2 * kPenRadius || from_middle.x() > kLabelHeight + 2 * kPenRadius)
      return 1;
    return kLabelHeight * std::min(first.distance((point - first_corner) / kLabelHeight),
                                   second.distance((point - second_corner) / kLabelHeight));
  }
};

/// Share of a pixel that lies within `radius` of a line at this distance; both in cells.
float coverage(float distance, float radius, float pixel) {
  return std::clamp((radius - distance) / pixel + 0.5F, 0.0F, 1.0F);
}

}  // namespace

Image checker_texture(int size) {
  Image image{size, size, std::vector<Color>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size))};
  std::vector<Label> labels;
  std::vector<CellStyle> styles;
  for (int i = 0; i < kCells * kCells; ++i) {
    labels.emplace_back(i % kCells, i / kCells);
    styles.push_back(cell_style(i % kCells, i / kCells));
  }
  const float pixel = static_cast<float>(kCells) / static_cast<float>(size);
  const Vec3 line = linear_from_oklch(0.98, 0.0, 0);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      // v points up, the rows of an image go down.
      const Vec2f place = pixel * Vec2f(static_cast<float>(x) + 0.5F, static_cast<float>(size - 1 - y) + 0.5F);
      const int column = std::min(static_cast<int>(place.x()), kCells - 1),
                row = std::min(static_cast<int>(place.y()), kCells - 1);
      const Vec2f inside = place - Vec2f(static_cast<float>(column), static_cast<float>(row));
      const CellStyle& style = styles[row * kCells + column];
      const float edge = std::min({inside.x(), 1 - inside.x(), inside.y(), 1 - inside.y()});
      const double on_line = coverage(edge, kCheckerLineWidth, pixel);
      const double on_label = coverage(labels[row * kCells + column].distance(inside), kPenRadius, pixel);
      const Vec3 labelled = (1 - on_label) * style.fill + on_label * style.label;
      image.at(x, y) = encode_srgb((1 - on_line) * labelled + on_line * line);
    }
  return image;
}

}  // namespace flowskin::tools
