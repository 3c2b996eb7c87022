#include "tools/textures/perceptual_color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flowskin::tools {

Vec3 linear_from_oklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(2 * std::numbers::pi * hue), b = chroma * std::sin(2 * std::numbers::pi * hue);
  const double l = lightness + 0.3963377774 * a + 0.2158037573 * b;
  const double m = lightness - 0.1055613458 * a - 0.0638541728 * b;
  const double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
  const Vec3 cones(l * l * l, m * m * m, s * s * s);
  const Vec3 linear(Vec3(4.0767416621, -3.3077115913, 0.2309699292).dot(cones),
                    Vec3(-1.2684380046, 2.6097574011, -0.3413193965).dot(cones),
                    Vec3(-0.0041960863, -0.7034186147, 1.7076147010).dot(cones));
  return linear.cwiseMax(0.0).cwiseMin(1.0);
}

Color encode_srgb(const Vec3& linear) {
  Color color{};
  for (int k = 0; k < 3; ++k) {
    const double x = std::clamp(linear[k], 0.0, 1.0);
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;  // IEC 61966-2-1
    color[k] = static_cast<std::uint8_t>(std::lround(255 * encoded));
  }
  return color;
}

}  // namespace flowskin::tools
