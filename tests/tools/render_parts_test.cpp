// Sampling, colour, texture filtering: the parts of the renderer by themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "tools/render/color.h"
#include "tools/render/film.h"
#include "tools/render/mip_map.h"
#include "tools/render/sampling.h"
#include "tools/render/trace_scene.h"

namespace flowskin::tools::render_parts_test {
namespace {

TEST(RenderSampling, EveryAlignedRunIsStratified) {
  const std::vector<Vec2f> points = scrambled_sobol(256, 7);
  for (std::size_t begin = 0; begin < points.size(); begin += 16) {
    // A (0,2) net: 16 points, one in each cell of 4 x 4, 16 x 1, 1 x 16, 8 x 2 and 2 x 8.
    for (const auto& [nx, ny] : {std::pair(4, 4), {16, 1}, {1, 16}, {8, 2}, {2, 8}}) {
      std::set<std::pair<int, int>> cells;
      for (std::size_t i = begin; i < begin + 16; ++i) {
        cells.emplace(int(points[i].x() * float(nx)), int(points[i].y() * float(ny)));
      }
      EXPECT_EQ(cells.size(), 16u) << nx << " x " << ny;
    }
  }
}

TEST(RenderSampling, AnyFourByFourPixelsUseAllSets) {
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      std::set<int> sets;
      for (int k = 0; k < 16; ++k) sets.insert(interleaved_set(x + k % 4, y + k / 4));
      EXPECT_EQ(sets.size(), 16u);
    }
  }
}

TEST(RenderSampling, HemisphereAndConeHaveTheMomentsOfTheory) {
  Vec3f mean = Vec3f::Zero();
  float square = 0;
  const auto hemisphere = cosine_hemisphere(1024, 3);
  for (const Vec3f& direction : hemisphere) {
    EXPECT_NEAR(direction.norm(), 1, 1e-5);
    mean += direction / 1024;
    square += direction.z() * direction.z() / 1024;
  }
  EXPECT_NEAR(mean.z(), 2.0 / 3, 2e-3);  // of the density cos / pi
  EXPECT_NEAR(mean.head<2>().norm(), 0, 2e-3);
  EXPECT_NEAR(square, 0.5, 2e-3);

  const Vec3f axis = Vec3f(0.3f, -0.8f, 0.4f).normalized();
  const float half_angle = 0.3f;
  mean.setZero();
  for (const Vec3f& direction : cone_directions(1024, 5, axis, half_angle)) {
    EXPECT_GE(direction.dot(axis), std::cos(half_angle) - 1e-5f);
    mean += direction / 1024;
  }
  EXPECT_NEAR(mean.dot(axis), (1 + std::cos(half_angle)) / 2, 1e-4);
  EXPECT_LT((mean - mean.dot(axis) * axis).norm(), 1e-3f);
}

TEST(RenderSampling, RotateToIsARotation) {
  for (const Vec3f& normal : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(0, 1, 0), Vec3f(0.48f, -0.6f, -0.64f)}) {
    EXPECT_LT((rotate_to(normal, Vec3f::UnitZ()) - normal).norm(), 1e-6f);
    const Vec3f a = rotate_to(normal, Vec3f::UnitX()), b = rotate_to(normal, Vec3f::UnitY());
    EXPECT_NEAR(a.norm(), 1, 1e-6);
    EXPECT_NEAR(b.norm(), 1, 1e-6);
    EXPECT_NEAR(a.dot(b), 0, 1e-6);
    EXPECT_NEAR(a.dot(normal), 0, 1e-6);
  }
}

TEST(RenderColor, CodesSurviveARoundTrip) {
  for (int i = 0; i < 256; ++i) {
    const Color color{std::uint8_t(i), std::uint8_t(255 - i), 0};
    EXPECT_EQ(to_srgb(to_linear(color)), color);
  }
  EXPECT_EQ(to_srgb({0.5f, 2, -1}), (Color{188, 255, 0}));  // half the light is code 188
}

TEST(RenderColor, FilmCurveRisesFromBlackToWhite) {
  EXPECT_EQ(film_curve(0), 0);
  EXPECT_EQ(film_curve(-1), 0);
  for (int i = 0; i < 2000; ++i) EXPECT_LE(film_curve(0.01f * float(i)), film_curve(0.01f * float(i + 1)));
  EXPECT_EQ(film_curve(100), 1);
  EXPECT_GT(film_curve(1), 0.6f);
  EXPECT_LT(film_curve(1), 0.95f);  // room for highlights
}

TEST(RenderMipMap, TilesAndFilters) {
  Image image{5, 3, std::vector<Color>(15)};  // not a power of two
  for (std::size_t i = 0; i < 15; ++i) image.pixels[i] = {std::uint8_t(17 * i), std::uint8_t(255 - 17 * i), 128};
  const MipMap map(image);
  EXPECT_EQ(map.texels(), 15);
  // The middle of texel (1, 0): second column, top row.
  EXPECT_LT((map.sample({1.5f / 5, 1 - 0.5f / 3}, 1) - to_linear(image.at(1, 0))).norm(), 1e-3f);
  for (const Vec2f& uv : {Vec2f(0.1f, 0.9f), Vec2f(0, 0), Vec2f(0.77f, 0.31f)}) {
    EXPECT_LT((map.sample(uv, 1) - map.sample(uv + Vec2f(3, -2), 1)).norm(), 1e-3f);
  }
  EXPECT_TRUE(map.sample({NAN, 0}, 1).allFinite());
  EXPECT_TRUE(map.sample({1e20f, 0}, NAN).allFinite());
}

TEST(RenderMipMap, CoarseLevelsKeepTheMean) {
  Image image{64, 64, std::vector<Color>(64 * 64)};
  Vec3f mean = Vec3f::Zero();
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {std::uint8_t(i * 37), std::uint8_t(i * i), std::uint8_t(i / 16)};
    mean += to_linear(image.pixels[i]) / 4096;
  }
  EXPECT_LT((MipMap(image).sample({0.3f, 0.4f}, 1e9f) - mean).norm(), 1e-3f);
}

TEST(RenderFilm, SmoothsLightButNotColor) {
  // One flat surface whose colour and light both vary from pixel to pixel in a 4 x 4 pattern.
  const int size = 12;
  Film film(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      Sample sample;
      sample.object = 1;
      sample.normal = Vec3f::UnitZ();
      sample.spacing = 1;
      sample.point = Vec3f(float(x), float(y), 0);
      sample.reflectance = Vec3f::Constant((x + y) & 1 ? 0.8f : 0.2f);
      sample.irradiance = Vec3f::Constant(float(interleaved_set(x, y)) / 7.5f);  // 1 on average
      film.set_pixel(x, y, {sample});
    }
  }
  const Image image = film.develop(true, 1);
  const float light = 1 / std::numbers::pi_v<float>;
  for (int y = 2; y < size - 2; ++y) {
    for (int x = 2; x < size - 2; ++x) {
      const Color expected = develop(Vec3f::Constant(((x + y) & 1 ? 0.8f : 0.2f) * light));
      EXPECT_LE(std::abs(image.at(x, y)[0] - expected[0]), 1);
    }
  }
}

TEST(RenderFilm, LightDoesNotLeakBetweenSurfaces) {
  Film film(8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      Sample sample;
      sample.object = x < 4 ? 1 : 2;
      sample.normal = Vec3f::UnitZ();
      sample.spacing = 1;
      sample.reflectance = Vec3f::Ones();
      sample.irradiance = Vec3f::Constant(x < 4 ? 0 : 1);
      film.set_pixel(x, y, {sample});
    }
  }
  const Image image = film.develop(true, 1);
  EXPECT_EQ(image.at(3, 4), (Color{0, 0, 0}));
  EXPECT_EQ(image.at(4, 4), image.at(7, 4));
}

TEST(RenderTrace, FindsTheNearestHit) {
  const TraceDevice device;
  TraceScene scene(device);
  scene.add_triangles({Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(0, 1, 0)}, {{0, 1, 2}});
  scene.add_balls({Vec3f(0, 0, -2), Vec3f(5, 0, 0)}, 0.5f);
  scene.commit();
  RayHit hit;
  ASSERT_TRUE(scene.intersect(Vec3f(0, 0, 3), Vec3f(0, 0, -1), 0, 100, hit));
  EXPECT_NEAR(hit.distance, 3, 1e-5);
  EXPECT_EQ(hit.geometry, 0u);
  EXPECT_LT((hit.normal - Vec3f::UnitZ()).norm(), 1e-6f);
  EXPECT_NEAR(hit.u, 0.25, 1e-6);
  EXPECT_NEAR(hit.v, 0.5, 1e-6);
  ASSERT_TRUE(scene.intersect(Vec3f(5, 0, 3), Vec3f(0, 0, -1), 0, 100, hit));
  EXPECT_NEAR(hit.distance, 2.5, 1e-4);
  EXPECT_EQ(hit.geometry, 1u);
  EXPECT_EQ(hit.primitive, 1u);
  EXPECT_FALSE(scene.intersect(Vec3f(0, 0, 3), Vec3f(0, 0, -1), 0, 2.9f, hit));
  EXPECT_FALSE(scene.intersect(Vec3f(0, 3, 3), Vec3f(0, 0, -1), 0, 100, hit));
  EXPECT_TRUE(scene.occluded(Vec3f(0, 0, 3), Vec3f(0, 0, -1), 0, 100));
  EXPECT_FALSE(scene.occluded(Vec3f(0, 0, 3), Vec3f(0, 0, 1), 0, 100));
}

}  // namespace
}  // namespace flowskin::tools::render_parts_test
