// Marble: veins are the zero lines of warped noise; all noise repeats over the tile.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tools/textures/image.h"
#include "tools/textures/perceptual_color.h"

namespace flowskin::tools {
namespace {

using Vec2d = Eigen::Vector2d;

/// A fixed mixing of bits [Steele et al., "Fast splittable pseudorandom number generators", 2014].
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// Gradient noise on the unit square that repeats with period 1 [Perlin, "Improving noise", 2002], in octaves, each
/// twice as fine and half as strong as the one before.
class TilingNoise {
 public:
  /// `frequency` cells along the square's edge in the first octave.
  TilingNoise(std::uint64_t seed, int frequency, int octaves) {
    for (int k = 0; k < octaves; ++k, frequency *= 2) {
      Octave& octave = octaves_.emplace_back(Octave{frequency, {}});
      const std::uint64_t start = mix(seed * 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(k) + 1);
      for (int i = 0; i < frequency * frequency; ++i) {
        const std::uint64_t bits = mix(start + 0x9e3779b97f4a7c15U * static_cast<std::uint64_t>(i));
        const double angle = 2 * std::numbers::pi * static_cast<double>(bits >> 11) * 0x1p-53;
        octave.gradients.emplace_back(std::cos(angle), std::sin(angle));
      }
    }
  }

  /// About -1 to 1.
  double operator()(double u, double v) const {
    double sum = 0, strength = 1;
    for (const Octave& octave : octaves_) {
      sum += strength * octave.value(u, v);
      strength /= 2;
      // Lattices that do not lie upon each other leave no trace of themselves in the sum.
      u += 0.37;
      v += 0.71;
    }
    return sum;
  }

 private:
  struct Octave {
    int frequency;
    std::vector<Vec2d> gradients;

    double value(double u, double v) const {
      const double x = (u - std::floor(u)) * frequency, y = (v - std::floor(v)) * frequency;
      const int i = std::min(static_cast<int>(x), frequency - 1), j = std::min(static_cast<int>(y), frequency - 1);
      const double s = x - i, t = y - j;
      const auto corner = [&](int right, int up) {
        const Vec2d& gradient = gradients[(j + up) % frequency * frequency + (i + right) % frequency];
        return gradient.x() * (s - right) + gradient.y() * (t - up);
      };
      const auto fade = [](double a) { return a * a * a * (a * (a * 6 - 15) + 10); };
      const double low = std::lerp(corner(0, 0), corner(1, 0), fade(s));
      const double high = std::lerp(corner(0, 1), corner(1, 1), fade(s));
      return std::lerp(low, high, fade(t));
    }
  };

  std::vector<Octave> octaves_;
};

/// 1 on a vein's middle line, falling to 0; `sharpness` is one over its width.
double vein(double noise, double sharpness) { return std::exp(-std::abs(noise) * sharpness); }

}  // namespace

Image marble_texture(int size, unsigned seed) {
  Image image{size, size, std::vector<Color>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size))};
  const std::uint64_t first = 8 * std::uint64_t{seed};
  const TilingNoise bend_u(first, 3, 5), bend_v(first + 1, 3, 5), cloud(first + 2, 2, 6), coming(first + 3, 3, 1);
  const TilingNoise thick_lines(first + 4, 3, 4), thin_lines(first + 5, 5, 4);
  const Vec3 stone = linear_from_oklch(0.955, 0.012, 0.22), shade = linear_from_oklch(0.74, 0.012, 0.70);
  const Vec3 ink = linear_from_oklch(0.29, 0.025, 0.72);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double u = (x + 0.5) / size, v = (size - 1 - y + 0.5) / size;
      const double bent_u = u + 0.11 * bend_u(u, v), bent_v = v + 0.11 * bend_v(u, v);
      // Thick veins come and go with a slow noise; thin ones fill the space between.
      const double thick = std::clamp(0.55 + 1.2 * coming(u, v), 0.0, 1.0) * vein(thick_lines(bent_u, bent_v), 22);
      const double thin = 0.52 * vein(thin_lines(bent_u, bent_v), 40);
      const double dark = 0.9 * (thick + thin * (1 - thick));
      const double shadow = std::clamp(0.22 - 0.55 * cloud(bent_u, bent_v), 0.0, 1.0);
      const Vec3 ground = (1 - shadow) * stone + shadow * shade;
      image.at(x, y) = encode_srgb((1 - dark) * ground + dark * ink);
    }
  return image;
}

}  // namespace flowskin::tools
