#include "tools/render/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flowskin::tools {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

// Second dimension of the Sobol sequence, whose generator matrix is Pascal's triangle modulo 2.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1) {
    if (index & 1u) result ^= column;
  }
  return result;
}

// Scrambles each digit depending on the ones above it (S. Laine and T. Karras 2011, constants of Burley 2020).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

float to_unit(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

}  // namespace

std::vector<Vec2f> scrambled_sobol(int count, std::uint32_t seed) {
  std::vector<Vec2f> points;
  points.reserve(std::size_t(count));
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
    points.emplace_back(to_unit(owen_scramble(reverse_bits(i), seed * 0x9e3779b9u + 0x3c6ef372u)),
                        to_unit(owen_scramble(second_dimension(i), seed * 0x85ebca6bu + 0x27d4eb2fu)));
  }
  return points;
}

Vec2f square_to_disc(const Vec2f& point) {
  const float a = 2 * point.x() - 1, b = 2 * point.y() - 1;
  if (a == 0 && b == 0) return Vec2f::Zero();
  constexpr float quarter = std::numbers::pi_v<float> / 4;
  const bool first = std::abs(a) > std::abs(b);
  const float radius = first ? a : b;
  const float angle = first ? quarter * b / a : 2 * quarter - quarter * a / b;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::vector<Vec3f> cosine_hemisphere(int count, std::uint32_t seed) {
  std::vector<Vec3f> directions;
  directions.reserve(std::size_t(count));
  for (const Vec2f& point : scrambled_sobol(count, seed)) {
    const Vec2f disc = square_to_disc(point);
    directions.emplace_back(disc.x(), disc.y(), std::sqrt(std::max(0.0f, 1 - disc.squaredNorm())));
  }
  return directions;
}

std::vector<Vec3f> cone_directions(int count, std::uint32_t seed, const Vec3f& axis, float half_angle) {
  std::vector<Vec3f> directions;
  directions.reserve(std::size_t(count));
  const float height = 1 - std::cos(half_angle);
  for (const Vec2f& point : scrambled_sobol(count, seed)) {
    // A disc of radius r onto a cap of height h = 1 - cos: z = 1 - h r^2 keeps areas (Archimedes).
    const Vec2f disc = square_to_disc(point);
    const float z = 1 - height * disc.squaredNorm();
    const float radius = std::sqrt(std::max(0.0f, height * (1 + z)));
    directions.push_back(rotate_to(axis, {disc.x() * radius, disc.y() * radius, z}).normalized());
  }
  return directions;
}

}  // namespace flowskin::tools
