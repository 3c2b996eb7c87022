// Samples to pixels: incoming light is smoothed between neighbours on the same surface, colours are not.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/textures/image.h"

namespace flowskin::tools {

/// One sample of a pixel. Its light is reflectance / pi * irradiance + extra.
struct Sample {
  Vec3f reflectance{0, 0, 0};
  Vec3f irradiance{0, 0, 0};
  Vec3f extra{0, 0, 0};      ///< Light that is not smoothed: backdrop, highlights.
  Vec3f unlit{0, 0, 0};      ///< Light that is shown as it is, neither smoothed nor developed.
  Vec3f point{0, 0, 0};      ///< Place and
  Vec3f normal{0, 0, 0};     ///< normal of the surface,
  float spacing = 0;         ///< distance to the points of the neighbouring pixels there (m),
  std::uint32_t object = 0;  ///< and which surface it is; `kNoObject` for the backdrop.
};
inline constexpr std::uint32_t kNoObject = 0;

/// Collects samples pixel by pixel and turns them into a picture.
class Film {
 public:
  Film(int width, int height);

  /// All samples of a pixel. One thread a row at a time.
  void set_pixel(int x, int y, const std::vector<Sample>& samples);

  /// The picture. `smooth`: the irradiance is averaged over 5 x 5 pixels within the same surface, with the weights that
  /// give each of the 16 interleaved sample sets the same share.
  Image develop(bool smooth, float exposure) const;

 private:
  // The samples of a pixel that lie on the same smooth piece of surface: sums, but for the geometry, which is that of
  // the first sample.
  struct Layer {
    Sample sum;
    float samples = 0;
  };
  struct Pixel {
    Layer first;
    std::uint32_t more_begin = 0, more_end = 0;  // further layers: a range of the row's list
  };
  static bool same_surface(const Sample& a, const Sample& b);
  static void add(Layer& layer, const Sample& sample);
  const Pixel& pixel(int x, int y) const { return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
  Vec3f smooth_irradiance(int x, int y, const Layer& layer) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<std::vector<Layer>> more_;  // a row
};

}  // namespace flowskin::tools
