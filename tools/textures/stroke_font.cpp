#include "tools/textures/stroke_font.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace flowskin::tools {
namespace {

/// Draws one glyph with lines and arcs of ellipses.
class Pen {
 public:
  explicit Pen(float width) { glyph_.width = width; }

  Pen& lines(std::initializer_list<Vec2f> points) {
    for (const Vec2f* p = points.begin(); p + 1 < points.end(); ++p) glyph_.segments.push_back({p[0], p[1]});
    return *this;
  }

  /// From angle `from` to `to` in degrees, counter-clockwise where `to` is larger.
  Pen& arc(const Vec2f& center, const Vec2f& radii, float from, float to) {
    constexpr int pieces = 14;
    const auto point = [&](int k) -> Vec2f {
      const float angle = (from + (to - from) * static_cast<float>(k) / pieces) * std::numbers::pi_v<float> / 180;
      return center + Vec2f(radii.x() * std::cos(angle), radii.y() * std::sin(angle));
    };
    for (int k = 0; k < pieces; ++k) glyph_.segments.push_back({point(k), point(k + 1)});
    return *this;
  }

  StrokeGlyph done() const { return glyph_; }

 private:
  StrokeGlyph glyph_;
};

StrokeGlyph letter(char character) {
  switch (character) {
    case 'A':
      return Pen(0.74F).lines({{0, 0}, {0.37F, 1}, {0.74F, 0}}).lines({{0.12F, 0.33F}, {0.62F, 0.33F}}).done();
    case 'B':
      return Pen(0.62F)
          .lines({{0.34F, 1}, {0, 1}, {0, 0}, {0.36F, 0}})
          .lines({{0, 0.53F}, {0.36F, 0.53F}})
          .arc({0.34F, 0.765F}, {0.24F, 0.235F}, -90, 90)
          .arc({0.36F, 0.265F}, {0.26F, 0.265F}, -90, 90)
          .done();
    case 'C':
      return Pen(0.70F).arc({0.40F, 0.5F}, {0.40F, 0.5F}, 48, 312).done();
    case 'D':
      return Pen(0.66F)
          .lines({{0.24F, 1}, {0, 1}, {0, 0}, {0.24F, 0}})
          .arc({0.24F, 0.5F}, {0.42F, 0.5F}, -90, 90)
          .done();
    case 'E':
      return Pen(0.54F).lines({{0.54F, 1}, {0, 1}, {0, 0}, {0.54F, 0}}).lines({{0, 0.52F}, {0.46F, 0.52F}}).done();
    case 'F':
      return Pen(0.52F).lines({{0.52F, 1}, {0, 1}, {0, 0}}).lines({{0, 0.50F}, {0.43F, 0.50F}}).done();
    case 'G':
      return Pen(0.74F)
          .arc({0.40F, 0.5F}, {0.40F, 0.5F}, 48, 330)
          .lines({{0.746F, 0.25F}, {0.746F, 0.46F}, {0.46F, 0.46F}})
          .done();
    case 'H':
      return Pen(0.66F)
          .lines({{0, 0}, {0, 1}})
          .lines({{0.66F, 0}, {0.66F, 1}})
          .lines({{0, 0.52F}, {0.66F, 0.52F}})
          .done();
    default:
      return {};
  }
}

StrokeGlyph digit(char character) {
  switch (character) {
    case '1':
      return Pen(0.36F).lines({{0, 0.76F}, {0.26F, 1}, {0.26F, 0}}).done();
    case '2':
      return Pen(0.60F)
          .arc({0.30F, 0.71F}, {0.29F, 0.29F}, 165, -30)
          .lines({{0.551F, 0.565F}, {0, 0}, {0.60F, 0}})
          .done();
    case '3':
      return Pen(0.58F)
          .arc({0.28F, 0.76F}, {0.25F, 0.24F}, 145, -90)
          .arc({0.28F, 0.26F}, {0.30F, 0.26F}, 90, -145)
          .done();
    case '4':
      return Pen(0.64F).lines({{0.64F, 0.26F}, {0, 0.26F}, {0.46F, 1}, {0.46F, 0}}).done();
    case '5':
      return Pen(0.60F)
          .lines({{0.53F, 1}, {0.09F, 1}, {0.05F, 0.53F}})
          .arc({0.27F, 0.325F}, {0.325F, 0.325F}, 132, -145)
          .done();
    case '6':
      return Pen(0.60F)
          .arc({0.30F, 0.31F}, {0.30F, 0.31F}, 0, 360)
          .lines({{0.005F, 0.36F}, {0.08F, 0.60F}, {0.22F, 0.82F}, {0.42F, 1}})
          .done();
    case '7':
      return Pen(0.58F).lines({{0, 1}, {0.58F, 1}, {0.20F, 0}}).done();
    case '8':
      return Pen(0.58F)
          .arc({0.29F, 0.765F}, {0.235F, 0.235F}, 0, 360)
          .arc({0.29F, 0.265F}, {0.29F, 0.265F}, 0, 360)
          .done();
    default:
      return {};
  }
}

}  // namespace

float StrokeGlyph::distance(const Vec2f& point) const {
  float nearest = std::numeric_limits<float>::max();
  for (const Segment& segment : segments) {
    const Vec2f along = segment.to - segment.from, offset = point - segment.from;
    const float share = std::clamp(offset.dot(along) / std::max(along.squaredNorm(), 1e-12F), 0.0F, 1.0F);
    nearest = std::min(nearest, (offset - share * along).squaredNorm());
  }
  return std::sqrt(nearest);
}

StrokeGlyph stroke_glyph(char character) {
  StrokeGlyph glyph = letter(character);
  return glyph.segments.empty() ? digit(character) : glyph;
}

}  // namespace flowskin::tools
