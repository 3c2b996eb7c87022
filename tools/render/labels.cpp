#include "tools/render/labels.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace flowskin::tools {
namespace {

using Vec2 = Eigen::Vector2d;

// A glyph is its character, its width (base 36) and strokes divided by spaces. A stroke's first character says how its
// points are joined: - straight, ~ by a quadratic B-spline from the first to the last, o by a closed one. A point is
// two digits of base 36: x, and y + 4; capitals reach from 4 (base line) to i, small letters to e, descenders to 0.
constexpr std::string_view kGlyphs[] = {
    "a8 o04848e0e -8e84",
    "b8 -0i04 o04848e0e",
    "c8 ~8c7e0e047486",
    "d8 o04848e0e -8i84",
    "e8 -0989 ~898e0e047486",
    "f6 ~6i3i3d34 -0e6e",
    "g8 o04848e0e ~8e85801002",
    "h8 -0i04 ~0a0e8e8a84",
    "i0 -0e04 -0i0i",
    "j2 ~2e252000 -2i2i",
    "k8 -0i04 -7e07 -3a84",
    "l0 -0i04",
    "mc -0e04 ~0a0e6e6a64 ~6a6ececac4",
    "n8 -0e04 ~0a0e8e8a84",
    "o8 o04848e0e",
    "p8 -0e00 o04848e0e",
    "q8 -8e80 o04848e0e",
    "r5 -0e04 ~0a0e5e",
    "s7 ~7c7e0e0979740406",
    "t6 ~2h272464 -0e5e",
    "u8 ~0e08048488 -8e84",
    "v8 -0e448e",
    "wc -0e346d94ce",
    "x7 -0e74 -7e04",
    "y8 -0e44 -8e20",
    "z7 -0e7e0474",
    "Aa -045ia4 -2989",
    "B9 -040i ~0i5i8i8b5b0b ~0b5b9b945404",
    "C9 ~9f8i0i048497",
    "D9 -040i ~0i4i9i944404",
    "E8 -8i0i0484 -0b7b",
    "F8 -8i0i04 -0b7b",
    "G9 ~9f8i0i04949b -5b9b",
    "H9 -040i -9i94 -0b9b",
    "I0 -040i",
    "J6 ~6i68640407",
    "K9 -040i -8i09 -3c94",
    "L7 -0i0474",
    "Ma -040i59aia4",
    "N9 -040i949i",
    "Oa o04a4ai0i",
    "P9 -040i ~0i5i9i9a5a0a",
    "Qa o04a4ai0i -67b3",
    "R9 -040i ~0i5i9i9a5a0a -5a94",
    "S8 ~8f8i0i0b8b840407",
    "Ta -0iai -5i54",
    "U9 ~0i090494999i",
    "Va -0i54ai",
    "Wg -0i448gc4gi",
    "X9 -0i94 -9i04",
    "Ya -0i5bai -5b54",
    "Z9 -0i9i0494",
    "08 o04848i0i",
    "18 -1f5i54",
    "28 ~0f0i8i8d04 -0484",
    "38 ~0g1i7i7b3b ~3b8b840407",
    "48 -646i0888",
    "58 -7i1i0b ~0b2d8d840406",
    "68 o04848d0d ~6i0g08",
    "78 -0i8i34",
    "88 o1b7b7i1i o04848b0b",
    "98 o09898i0i ~24868e",
    " 4",
    ".0 -0404",
    ",1 -1402",
    ":0 -0404 -0d0d",
    ";1 -1402 -1d1d",
    "-6 -0969",
    "_8 -0383",
    "+8 -0989 -4d45",
    "=8 -0b8b -0787",
    "/7 -037i",
    "(3 ~3i0e0832",
    ")3 ~0i3e3802",
    "%a -049i o0d3d3i0i o64a4a969",
    "#9 -243i -647i -0989 -0d9d",
    "'0 -0i0f",
    "\"3 -0i0f -3i3f",
    "!0 -0i09 -0404",
    "?7 ~0f0i7i7c3c39 -3434",
    "<8 -8d0985",
    ">8 -0d8905",
    "*6 -3i3c -0g6e -6g0e",
    "[3 -3i0i0232",
    "]3 -0i3i3202",
    "|0 -0i02",
    "~8 ~082d678b",
    "^6 -0e3i6e",
    "\\7 -0i73",
    "{3 ~3i0i0b0232",
    "}3 ~0i3i3b3202",
};
constexpr std::string_view kUnknownGlyph = "?8 -04848i0i04";
constexpr double kCapitalHeight = 14, kGap = 4.4, kStrokeWidth = 1.9;

double digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

std::string_view glyph(char c) {
  for (const std::string_view candidate : kGlyphs) {
    if (candidate.front() == c) return candidate;
  }
  return kUnknownGlyph;
}

// One glyph a character: the later bytes of a UTF-8 character are no characters.
bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }

// Continues a polyline with a parabola.
void append_curve(std::vector<Vec2>& out, const Vec2& control, const Vec2& to) {
  constexpr int pieces = 8;
  const Vec2 from = out.back();
  for (int k = 1; k <= pieces; ++k) {
    const double t = double(k) / pieces;
    out.push_back((1 - t) * (1 - t) * from + 2 * t * (1 - t) * control + t * t * to);
  }
}

// The polyline of a stroke such as "-0i04".
std::vector<Vec2> flatten(std::string_view stroke) {
  std::vector<Vec2> points;
  for (std::size_t k = 1; k + 1 < stroke.size(); k += 2)
    points.emplace_back(digit(stroke[k]), digit(stroke[k + 1]) - 4);
  const std::size_t n = points.size();
  if (stroke.front() == '-' || n < 3) return points;
  std::vector<Vec2> line;
  if (stroke.front() == 'o') {
    line.push_back((points[n - 1] + points[0]) / 2);
    for (std::size_t k = 0; k < n; ++k) append_curve(line, points[k], (points[k] + points[(k + 1) % n]) / 2);
    return line;
  }
  line.push_back(points[0]);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const Vec2 to = k + 2 < n ? Vec2((points[k] + points[k + 1]) / 2) : points[n - 1];
    append_curve(line, points[k], to);
  }
  return line;
}

// Coverage of pixels by the text, so that strokes which cross do not darken twice.
class Mask {
 public:
  Mask(int width, int height)
      : width_(width), height_(height), coverage_(std::size_t(width) * std::size_t(height), 0.0f) {}

  void draw_segment(const Vec2& a, const Vec2& b, double radius) {
    const Vec2 low = a.cwiseMin(b).array() - radius - 1, high = a.cwiseMax(b).array() + radius + 1;
    const int x_end = int(std::clamp(std::ceil(high.x()), 0.0, double(width_)));
    const int y_end = int(std::clamp(std::ceil(high.y()), 0.0, double(height_)));
    const Vec2 along = b - a;
    const double length2 = along.squaredNorm();
    for (int y = int(std::clamp(low.y(), 0.0, double(height_))); y < y_end; ++y) {
      for (int x = int(std::clamp(low.x(), 0.0, double(width_))); x < x_end; ++x) {
        const Vec2 point(x + 0.5, y + 0.5);
        const double t = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
        const double inside = radius + 0.5 - (point - a - t * along).norm();
        float& value = coverage_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
        value = std::max(value, float(std::clamp(inside, 0.0, 1.0)));
      }
    }
  }

  void blend(Image& image, const Color& color) const {
    for (std::size_t i = 0; i < coverage_.size(); ++i) {
      if (coverage_[i] == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const float old = image.pixels[i][c];
        image.pixels[i][c] = std::uint8_t(std::lround(old + coverage_[i] * (float(color[c]) - old)));
      }
    }
  }

 private:
  int width_, height_;
  std::vector<float> coverage_;
};

}  // namespace

double text_width(const std::string& text, double height) {
  double width = 0;
  for (const char c : text) {
    if (starts_character(c)) width += digit(glyph(c)[1]) + kGap;
  }
  return std::max(0.0, width - kGap) * height / kCapitalHeight;
}

void draw_text(Image& image, double x, double y, double height, const std::string& text, const Color& color,
               TextDirection direction) {
  const double scale = height / kCapitalHeight, radius = 0.5 * kStrokeWidth * scale;
  Mask mask(image.width, image.height);
  double pen = 0;
  const auto place = [&](const Vec2& point) -> Vec2 {
    const Vec2 p = scale * (point + Vec2(pen, 0));
    return direction == TextDirection::right ? Vec2(x + p.x(), y - p.y()) : Vec2(x - p.y(), y - p.x());
  };
  for (const char c : text) {
    if (!starts_character(c)) continue;
    std::string_view rest = glyph(c);
    const double width = digit(rest[1]);
    for (std::size_t space = rest.find(' ', 1); space != std::string_view::npos; space = rest.find(' ')) {
      rest.remove_prefix(space + 1);
      const std::vector<Vec2> line = flatten(rest.substr(0, rest.find(' ')));
      if (line.size() == 1) mask.draw_segment(place(line[0]), place(line[0]), radius);
      for (std::size_t k = 0; k + 1 < line.size(); ++k) mask.draw_segment(place(line[k]), place(line[k + 1]), radius);
    }
    pen += width + kGap;
  }
  mask.blend(image, color);
}

}  // namespace flowskin::tools
