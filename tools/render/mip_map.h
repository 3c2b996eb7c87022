// Filtered texture look-up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/textures/image.h"

namespace flowskin::tools {

/// An image in linear light at all halved sizes. Tiles in both directions; as in OBJ and OpenGL, (0, 0) is the lower
/// left corner of the image and v grows upwards.
class MipMap {
 public:
  /// An empty image acts as one grey pixel.
  explicit MipMap(const Image& image);

  /// Texels of the full size on a unit square of texture coordinates.
  float texels() const { return float(levels_.front().width) * float(levels_.front().height); }
  /// Linear colour, averaged over about `texels_covered` texels (trilinear filtering).
  Vec3f sample(const Vec2f& uv, float texels_covered) const;

 private:
  struct Level {
    int width = 1, height = 1;
    std::vector<std::array<std::uint16_t, 3>> texels;  ///< Linear, 65535 is 1.
  };
  static Level halve(const Level& fine);
  static Vec3f bilinear(const Level& level, const Vec2f& uv);

  std::vector<Level> levels_;
};

}  // namespace flowskin::tools
