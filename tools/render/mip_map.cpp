#include "tools/render/mip_map.h"

#include <algorithm>
#include <cmath>

#include "tools/render/color.h"

namespace flowskin::tools {

MipMap::MipMap(const Image& image) {
  Level full;
  if (image.width <= 0 || image.height <= 0) {
    full.texels.push_back({32768, 32768, 32768});
  } else {
    full.width = image.width;
    full.height = image.height;
    full.texels.reserve(image.pixels.size());
    for (const Color& pixel : image.pixels) {
      const Vec3f linear = 65535 * to_linear(pixel);
      full.texels.push_back({std::uint16_t(std::lround(linear.x())), std::uint16_t(std::lround(linear.y())),
                             std::uint16_t(std::lround(linear.z()))});
    }
  }
  levels_.push_back(std::move(full));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halve(levels_.back()));
}

MipMap::Level MipMap::halve(const Level& fine) {
  Level coarse;
  coarse.width = std::max(1, fine.width / 2);
  coarse.height = std::max(1, fine.height / 2);
  coarse.texels.resize(std::size_t(coarse.width) * std::size_t(coarse.height));
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) {
      std::array<unsigned, 3> sum{2, 2, 2};  // rounds to nearest
      for (int k = 0; k < 4; ++k) {
        const int fine_x = std::min(2 * x + (k & 1), fine.width - 1),
                  fine_y = std::min(2 * y + (k >> 1), fine.height - 1);
        const auto& texel = fine.texels[std::size_t(fine_y) * std::size_t(fine.width) + std::size_t(fine_x)];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += texel[c];
      }
      auto& out = coarse.texels[std::size_t(y) * std::size_t(coarse.width) + std::size_t(x)];
      for (std::size_t c = 0; c < 3; ++c) out[c] = std::uint16_t(sum[c] / 4);
    }
  }
  return coarse;
}

Vec3f MipMap::bilinear(const Level& level, const Vec2f& uv) {
  const float x = (uv.x() - std::floor(uv.x())) * float(level.width) - 0.5f;
  const float y = (1 - (uv.y() - std::floor(uv.y()))) * float(level.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const auto wrap = [](int i, int n) { return i < 0 ? i + n : (i >= n ? i - n : i); };
  const int x0 = wrap(int(left), level.width), x1 = wrap(int(left) + 1, level.width);
  const int y0 = wrap(int(top), level.height), y1 = wrap(int(top) + 1, level.height);
  const auto texel = [&](int i, int j) -> Vec3f {
    const auto& t = level.texels[std::size_t(j) * std::size_t(level.width) + std::size_t(i)];
    return Vec3f(float(t[0]), float(t[1]), float(t[2])) / 65535;
  };
  const float a = x - left, b = y - top;
  return (1 - b) * ((1 - a) * texel(x0, y0) + a * texel(x1, y0)) + b * ((1 - a) * texel(x0, y1) + a * texel(x1, y1));
}

Vec3f MipMap::sample(const Vec2f& uv, float texels_covered) const {
  if (!uv.allFinite() || uv.cwiseAbs().maxCoeff() > 1e6f) return bilinear(levels_.back(), Vec2f::Zero());
  const float level = 0.5f * std::log2(std::max(texels_covered, 1.0f));
  const auto last = levels_.size() - 1;
  if (level >= float(last)) return bilinear(levels_[last], uv);
  const auto fine = std::size_t(level);
  const float blend = level - float(fine);
  const Vec3f detailed = bilinear(levels_[fine], uv);
  return blend > 0 ? Vec3f((1 - blend) * detailed + blend * bilinear(levels_[fine + 1], uv)) : detailed;
}

}  // namespace flowskin::tools
