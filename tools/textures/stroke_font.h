// A tiny font of strokes: the letters A to H and the digits 1 to 8, for the UV grid.
#pragma once

#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// A glyph as line segments in a box 1 high (y up) and `width` wide, drawn with a round pen.
struct StrokeGlyph {
  struct Segment {
    Vec2f from, to;
  };
  float width = 0;
  std::vector<Segment> segments;

  /// Distance from a point to the nearest stroke's middle line, in glyph heights.
  float distance(const Vec2f& point) const;
};

/// The glyph of 'A' to 'H' or '1' to '8'; an empty one for any other character.
StrokeGlyph stroke_glyph(char character);

}  // namespace flowskin::tools
