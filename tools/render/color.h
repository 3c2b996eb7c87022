// Colour: sRGB coding and the film curve. All shading is done in linear light with the primaries of sRGB.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// sRGB (IEC 61966-2-1) to linear light, both 0 to 1.
inline float srgb_to_linear(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/// Linear light to sRGB, both 0 to 1.
inline float linear_to_srgb(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}

/// Linear light of an 8-bit colour.
inline Vec3f to_linear(const Color& color) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (int i = 0; i < 256; ++i) values[std::size_t(i)] = srgb_to_linear(float(i) / 255);
    return values;
  }();
  return {table[color[0]], table[color[1]], table[color[2]]};
}

/// 8-bit colour of linear light, which is cut to 0 to 1.
inline Color to_srgb(const Vec3f& linear) {
  Color color;
  for (int i = 0; i < 3; ++i) {
    const float clamped = linear[i] > 0 ? std::min(linear[i], 1.0f) : 0.0f;  // NaN becomes 0
    color[std::size_t(i)] = std::uint8_t(std::lround(255 * linear_to_srgb(clamped)));
  }
  return color;
}

/// Film curve: scene light (1 = a white surface in full light) to display light. A rational fit to the ACES reference
/// transform (K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016): toe, straight middle, soft shoulder.
inline float film_curve(float light) {
  const float x = 0.6f * std::max(light, 0.0f);
  return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
}

/// Film curve on each channel, coded for the screen.
inline Color develop(const Vec3f& light) {
  return to_srgb({film_curve(light.x()), film_curve(light.y()), film_curve(light.z())});
}

}  // namespace flowskin::tools
