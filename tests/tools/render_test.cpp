// Pictures against theory: areas, places, colours, light.
#include <gtest/gtest.h>
#include <omp.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/errors.h"
#include "tools/render/camera.h"
#include "tools/render/color.h"
#include "tools/render/lighting.h"
#include "tools/render/renderer.h"
#include "tools/render/subject.h"

namespace flowskin::tools::render_test {
namespace {

constexpr double pi = std::numbers::pi;

// Looks along -z at the origin from 4 m away; neither walls nor ground.
scenes::RenderSpec front_view(int width = 240, int height = 160) {
  scenes::RenderSpec spec;
  spec.width = width;
  spec.height = height;
  spec.ground = false;
  spec.camera.position = Vec3(0, 0, 4);
  spec.camera.look_at = Vec3::Zero();
  spec.camera.vertical_fov = 40;
  return spec;
}

const sph::Box unit_box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};

Image flat_image(const Color& color) { return {1, 1, {color}}; }

// A square of the given half size in the plane z = 0, facing the camera of front_view; `tiles` copies of the texture.
SurfaceFrame square(double half, float tiles = 1) {
  SurfaceFrame frame;
  frame.mesh.positions = {Vec3(-half, -half, 0), Vec3(half, -half, 0), Vec3(half, half, 0), Vec3(-half, half, 0)};
  frame.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  frame.normals.assign(4, Vec3::UnitZ());
  frame.colors.assign(4, Color{200, 60, 60});
  const Vec2f a(0, 0), b(tiles, 0), c(tiles, tiles), d(0, tiles);
  frame.corner_uvs = {{a, b, c}, {a, c, d}};
  return frame;
}

ParticleFrame ball(const Vec3& center, double radius) {
  ParticleFrame frame;
  frame.state.positions = {center};
  frame.colors = {Color{220, 40, 40}};
  frame.radius = radius;
  return frame;
}

// A sphere of triangles with a colour, a normal and texture coordinates at each vertex.
SurfaceFrame sphere(const Vec3& center, double radius, int rings) {
  SurfaceFrame frame;
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const double u = 2 * pi * i / around, v = pi * j / rings;
      const Vec3 normal(std::sin(v) * std::sin(u), std::cos(v), std::sin(v) * std::cos(u));
      frame.mesh.positions.push_back(center + radius * normal);
      frame.normals.push_back(normal);
      frame.colors.push_back(to_srgb((0.5 * (normal + Vec3::Ones())).cast<float>()));
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      const auto uv = [&](int k, int l) {
        return Vec2f(float(4 * k) / float(around), 1 - float(2 * l) / float(rings));
      };
      frame.mesh.triangles.push_back({a, a + around, b + around});
      frame.corner_uvs.push_back({uv(i, j), uv(i, j + 1), uv(i + 1, j + 1)});
      frame.mesh.triangles.push_back({a, b + around, b});
      frame.corner_uvs.push_back({uv(i, j), uv(i + 1, j + 1), uv(i + 1, j)});
    }
  }
  return frame;
}

int difference(const Color& a, const Color& b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(int(a[c]) - int(b[c])));
  return largest;
}

int brightness(const Color& color) { return color[0] + color[1] + color[2]; }

scenes::BoundarySpec floor_wall(double half, double height) {
  scenes::BoundarySpec wall;
  wall.boundary.mesh.positions = {Vec3(-half, height, -half), Vec3(-half, height, half), Vec3(half, height, half),
                                  Vec3(half, height, -half)};
  wall.boundary.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return wall;
}

TEST(Render, BallCoversTheDiscOfTheory) {
  const scenes::RenderSpec spec = front_view();
  const Renderer renderer(spec, {}, {}, unit_box);
  const double radius = 0.9, distance = 4;
  const Image empty = renderer.draw(ParticleFrame{}), image = renderer.draw(ball(Vec3::Zero(), radius));
  int covered = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) covered += difference(image.pixels[i], empty.pixels[i]) > 40;
  // The silhouette of a ball on the axis is the cone that touches it: sin = r / d.
  const double pixels_per_slope = spec.height / 2.0 / std::tan(20 * pi / 180);
  const double disc = pixels_per_slope * std::tan(std::asin(radius / distance));
  EXPECT_NEAR(covered, pi * disc * disc, 0.02 * pi * disc * disc);
}

TEST(Render, SurfaceAndBallOfTheSameSizeCoverTheSame) {
  scenes::RenderSpec spec = front_view();
  spec.style = "solid";
  const Renderer renderer(spec, {}, {}, unit_box);
  const Image empty = renderer.draw(SurfaceFrame{});
  SurfaceFrame red = sphere(Vec3(0.2, 0.1, 0), 0.8, 64);
  red.colors.assign(red.colors.size(), Color{220, 40, 40});
  const Image surface = renderer.draw(red);
  const Image particle = renderer.draw(ball(Vec3(0.2, 0.1, 0), 0.8));
  int one_only = 0;
  for (std::size_t i = 0; i < empty.pixels.size(); ++i) {
    one_only +=
        (difference(surface.pixels[i], empty.pixels[i]) > 30) != (difference(particle.pixels[i], empty.pixels[i]) > 30);
  }
  EXPECT_LT(one_only, 20);  // of 9,000
}

TEST(Render, TextureIsNotMirrored) {
  // Rows from top to bottom: red, green / blue, white.
  const Image corners{2, 2, {Color{230, 20, 20}, Color{20, 230, 20}, Color{20, 20, 230}, Color{230, 230, 230}}};
  const Renderer renderer(front_view(), {}, corners, unit_box);
  const Image image = renderer.draw(square(1));
  const int x0 = 90, x1 = 150, y0 = 50, y1 = 110;
  const Color top_left = image.at(x0, y0), top_right = image.at(x1, y0), low_left = image.at(x0, y1),
              low_right = image.at(x1, y1);
  EXPECT_GT(top_left[0], top_left[1] + 60);
  EXPECT_GT(top_left[0], top_left[2] + 60);
  EXPECT_GT(top_right[1], top_right[0] + 60);
  EXPECT_GT(low_left[2], low_left[0] + 60);
  EXPECT_LT(difference({low_right[0], low_right[0], low_right[0]}, low_right), 40);
}

TEST(Render, TextureStaysSharp) {
  // Left half black, right half white: the edge is at the middle of the square, which is the middle of the picture.
  Image halves{64, 64, std::vector<Color>(64 * 64)};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) halves.at(x, y) = x < 32 ? Color{0, 0, 0} : Color{255, 255, 255};
  }
  const Renderer renderer(front_view(), {}, halves, unit_box);
  const Image image = renderer.draw(square(1));
  EXPECT_LT(image.at(115, 80)[1], 70);
  EXPECT_GT(image.at(124, 80)[1], 180);
}

TEST(Render, FarCheckerTurnsGrey) {
  Image checker{64, 64, std::vector<Color>(64 * 64)};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) checker.at(x, y) = ((x / 8) ^ (y / 8)) & 1 ? Color{255, 255, 255} : Color{0, 0, 0};
  }
  const Renderer renderer(front_view(), {}, checker, unit_box);
  const Image image = renderer.draw(square(1, 100));  // about 1 pixel a tile
  for (int y = 50; y < 110; ++y) {
    for (int x = 90; x < 150; ++x) ASSERT_LT(difference(image.at(x, y), image.at(120, 80)), 12) << x << " " << y;
  }
}

TEST(Render, OpenGroundHasTheBrightnessOfTheory) {
  scenes::RenderSpec spec = front_view();
  spec.ground = true;
  spec.camera.position = Vec3(0, 3, 0.5);
  const Renderer renderer(spec, {}, {}, unit_box);
  const Image image = renderer.draw(SurfaceFrame{});
  const Lighting light = make_lighting(spec);
  // Irradiance of the sky on a horizontal plane by midpoint quadrature, independent of the renderer's samples.
  Vec3f irradiance = light.sun_direction.y() * light.sun_irradiance;
  const int n = 300;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const float polar = float(pi / 2 * (i + 0.5) / n), azimuth = float(2 * pi * (j + 0.5) / n);
      const Vec3f direction(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      irradiance += light.sky(direction) * std::cos(polar) * std::sin(polar) * float(pi * pi / n / n);
    }
  }
  const Color expected = develop(0.45f / float(pi) * irradiance);
  EXPECT_LE(difference(image.at(120, 80), expected), 2);
}

TEST(Render, ObjectsCastSoftShadows) {
  scenes::RenderSpec spec = front_view();
  spec.ground = true;
  spec.light_direction = Vec3(1, 1, 0);
  spec.camera.position = Vec3(0, 4, 3);
  const Renderer renderer(spec, {}, {}, unit_box);
  const Image empty = renderer.draw(ParticleFrame{}), image = renderer.draw(ball(Vec3(0, 0.6, 0), 0.3));
  const Camera camera(spec.camera, spec.width, spec.height, Vec3::Zero());
  const auto change = [&](const Vec3& point) {
    const Vec2f pixel = camera.project(point);
    return brightness(empty.at(int(pixel.x()), int(pixel.y()))) - brightness(image.at(int(pixel.x()), int(pixel.y())));
  };
  EXPECT_GT(change(Vec3(-0.6, 0, 0)), 100);          // where the sun's line through the centre meets the ground
  EXPECT_GT(change(Vec3(-0.05, 0, 0.1)), 10);        // beneath, part of the sky is hidden
  EXPECT_LT(std::abs(change(Vec3(1.2, 0, 0))), 12);  // towards the light: hardly anything
  const int core = change(Vec3(-0.6, 0, 0)), edge = change(Vec3(-1.03, 0, 0));
  EXPECT_GT(edge, 20);  // the penumbra lies between
  EXPECT_LT(edge, core - 20);
}

TEST(Render, WallsAreDrawnFromBothSidesUnlessHidden) {
  scenes::RenderSpec spec = front_view();
  spec.camera.position = Vec3(0, 2, 3);
  scenes::BoundarySpec wall = floor_wall(0.5, 0);
  scenes::BoundarySpec turned = wall;
  for (auto& triangle : turned.boundary.mesh.triangles) std::swap(triangle[1], triangle[2]);
  const Image up = Renderer(spec, {wall}, {}, unit_box).draw(SurfaceFrame{});
  EXPECT_EQ(up.pixels, Renderer(spec, {turned}, {}, unit_box).draw(SurfaceFrame{}).pixels);
  wall.visible = false;
  const Image none = Renderer(spec, {wall}, {}, unit_box).draw(SurfaceFrame{});
  EXPECT_EQ(none.pixels, Renderer(spec, {}, {}, unit_box).draw(SurfaceFrame{}).pixels);
  EXPECT_GT(difference(up.at(120, 80), none.at(120, 80)), 10);
}

TEST(Render, SolidStyleShowsTheVertexColors) {
  scenes::RenderSpec spec = front_view();
  spec.style = "solid";
  const Image image = Renderer(spec, {}, flat_image({0, 0, 255}), unit_box).draw(square(1));
  const Color middle = image.at(120, 80);
  EXPECT_GT(middle[0], middle[1] + 60);
  EXPECT_LT(std::abs(middle[1] - middle[2]), 30);
}

TEST(Render, BlendsTheSecondTextureByItsShare) {
  // The left half of the texture is red, the right half blue.
  const Image two{2, 1, {{255, 0, 0}, {0, 0, 255}}};
  const Renderer renderer(front_view(), {}, two, unit_box);
  const auto all_at = [](float u) {
    const Vec2f a(u, 0.5F), b(u + 1e-4F, 0.5F), c(u, 0.5F + 1e-4F);
    return std::vector<std::array<Vec2f, 3>>{{a, b, c}, {a, b, c}};
  };
  SurfaceFrame red = square(1), blue = square(1);
  red.corner_uvs = all_at(0.25F);
  blue.corner_uvs = all_at(0.75F);
  SurfaceFrame both = red;
  both.corner_uvs2 = blue.corner_uvs;
  both.texture_blend.assign(4, 0.0F);
  EXPECT_EQ(renderer.draw(both).pixels, renderer.draw(red).pixels);
  both.texture_blend.assign(4, 1.0F);
  EXPECT_EQ(renderer.draw(both).pixels, renderer.draw(blue).pixels);
  both.texture_blend.assign(4, 0.5F);
  const Color middle = renderer.draw(both).at(120, 80);
  // Half of each, in linear light: sRGB codes 188 for a reflectance of 0.5.
  const Color purple = Renderer(front_view(), {}, flat_image({188, 0, 188}), unit_box).draw(square(1)).at(120, 80);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(middle[channel], purple[channel], 1) << channel;
  // Without second coordinates it is the solid colour that shows.
  both.corner_uvs2.clear();
  both.texture_blend.assign(4, 1.0F);
  scenes::RenderSpec solid = front_view();
  solid.style = "solid";
  EXPECT_EQ(renderer.draw(both).pixels, Renderer(solid, {}, two, unit_box).draw(both).pixels);
  both.texture_blend.pop_back();
  EXPECT_THROW(renderer.draw(both), InputError);
}

TEST(Render, NormalsStyleCanBeReadOff) {
  scenes::RenderSpec spec = front_view();
  spec.style = "normals";
  spec.exposure = 3;  // has no part in it
  SurfaceFrame frame = square(1);
  const Vec3 normal = Vec3(0.3, -0.5, 0.6).normalized();
  frame.normals.assign(4, normal);
  const Color middle = Renderer(spec, {}, {}, unit_box).draw(frame).at(120, 80);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[std::size_t(c)], 255 * (0.5 + 0.5 * normal[c]), 1.0);
}

TEST(Render, EmptyFramesShowTheSceneAlone) {
  scenes::RenderSpec spec = front_view(64, 48);
  spec.ground = true;
  const Renderer renderer(spec, {floor_wall(0.5, 0.2)}, {}, unit_box);
  const Image surface = renderer.draw(SurfaceFrame{}), particles = renderer.draw(ParticleFrame{});
  EXPECT_EQ(surface.width, 64);
  EXPECT_EQ(surface.height, 48);
  EXPECT_EQ(surface.pixels.size(), 64u * 48u);
  EXPECT_EQ(surface.pixels, particles.pixels);
}

TEST(Render, SameBytesAtAnyThreadCount) {
  scenes::RenderSpec spec = front_view();
  spec.ground = true;
  spec.ground_height = -1;
  Image texture{16, 16, std::vector<Color>(256)};
  for (int i = 0; i < 256; ++i)
    texture.pixels[std::size_t(i)] = {std::uint8_t(i), std::uint8_t(7 * i), std::uint8_t(31 * i)};
  ParticleFrame balls;
  for (int i = 0; i < 500; ++i) {
    balls.state.positions.push_back(Vec3(std::sin(1.0 * i), std::sin(2.3 * i), std::sin(3.7 * i)));
    balls.colors.push_back(texture.pixels[std::size_t(i % 256)]);
  }
  balls.radius = 0.1;
  const int before = omp_get_max_threads();
  const auto pictures = [&](int threads) {
    omp_set_num_threads(threads);
    const Renderer renderer(spec, {floor_wall(1.5, -0.9)}, texture, unit_box);
    return std::pair(renderer.draw(sphere(Vec3::Zero(), 0.8, 24)).pixels, renderer.draw(balls).pixels);
  };
  const auto one = pictures(1), two = pictures(2), five = pictures(5);
  omp_set_num_threads(before);
  EXPECT_TRUE(one == two);
  EXPECT_TRUE(one == five);
}

TEST(Render, SameBytesFarFromTheOrigin) {
  // The renderer works in single precision: positions must be taken relative to the scene first.
  const Vec3 away(4096, -2048, 8192);  // exact in double precision
  scenes::RenderSpec near = front_view(), far = near;
  far.camera.position += away;
  far.camera.look_at += away;
  ParticleFrame here = ball(Vec3(0.25, 0.125, 0), 0.5), there = here;
  there.state.positions[0] += away;
  EXPECT_EQ(Renderer(near, {}, {}, unit_box).draw(here).pixels,
            Renderer(far, {}, {}, {unit_box.min + away, unit_box.max + away}).draw(there).pixels);
}

#if defined(__SSE__)
TEST(Render, LeavesFloatingPointSettingsAlone) {
  const Renderer renderer(front_view(32, 32), {}, {}, unit_box);
  const auto settings = [] {
    std::vector<unsigned> all(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
    all[std::size_t(omp_get_thread_num())] = _mm_getcsr() & ~0x3fu;  // without the sticky exception flags
    return all;
  };
  const auto before = settings();
  renderer.draw(ball(Vec3::Zero(), 0.5));
  EXPECT_EQ(settings(), before);
}
#endif

TEST(Render, AutomaticCameraSeesEverythingAndFillsThePicture) {
  for (const double aspect : {0.5, 1.0, 16.0 / 9}) {
    for (const Vec3& size : {Vec3(1, 1, 1), Vec3(5, 0.5, 1), Vec3(0.2, 3, 0.2), Vec3(1e-3, 1e-3, 2e-3)}) {
      std::vector<Vec3> points;
      for (int k = 0; k < 8; ++k) {
        points.push_back(Vec3(7, -2, 3) + Vec3(k & 1 ? size.x() : 0, k & 2 ? size.y() : 0, k & 4 ? size.z() : 0));
      }
      const scenes::CameraSpec placed = place_camera({}, aspect, points);
      const int height = 500, width = int(height * aspect);
      const Camera camera(placed, width, height, Vec3::Zero());
      Vec2f low(1e9f, 1e9f), high(-1e9f, -1e9f);
      for (const Vec3& point : points) {
        EXPECT_GT((point - placed.position).dot(placed.look_at - placed.position), 0);
        low = low.cwiseMin(camera.project(point));
        high = high.cwiseMax(camera.project(point));
      }
      EXPECT_GE(low.minCoeff(), 0);
      EXPECT_LE(high.x(), width);
      EXPECT_LE(high.y(), height);
      EXPECT_GT(std::max((high.x() - low.x()) / float(width), (high.y() - low.y()) / float(height)), 0.85f);
      EXPECT_NEAR(low.x() + high.x(), width, 2);
      EXPECT_NEAR(low.y() + high.y(), height, 2);
    }
  }
}

TEST(Render, CameraDirectionsAndProjectionAgree) {
  scenes::CameraSpec spec;
  spec.position = Vec3(1, 2, 3);
  spec.look_at = Vec3(-1, 0.5, 0.2);
  const Camera camera(spec, 320, 200, Vec3::Zero());
  for (const Vec2f& pixel : {Vec2f(0, 0), Vec2f(160, 100), Vec2f(311.5f, 20.25f)}) {
    const Vec3 point = spec.position + 3.7 * camera.direction(pixel.x(), pixel.y()).cast<double>();
    EXPECT_LT((camera.project(point) - pixel).norm(), 1e-2f);
  }
  EXPECT_LT((camera.direction(160, 100).cast<double>() - (spec.look_at - spec.position).normalized()).norm(), 1e-6);
  spec.look_at = spec.position - Vec3(0, 5, 0);  // straight down, along the up direction
  EXPECT_TRUE(Camera(spec, 320, 200, Vec3::Zero()).direction(10, 10).allFinite());
}

TEST(Render, BadFramesAreRefused) {
  const Renderer renderer(front_view(16, 16), {}, {}, unit_box);
  SurfaceFrame frame = square(1);
  frame.mesh.positions[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(renderer.draw(frame), InputError);
  frame = square(1);
  frame.mesh.triangles[1][2] = 4;
  EXPECT_THROW(renderer.draw(frame), InputError);
  frame = square(1);
  frame.corner_uvs.pop_back();
  EXPECT_THROW(renderer.draw(frame), InputError);
  frame = square(1);
  frame.normals.clear();
  EXPECT_THROW(renderer.draw(frame), InputError);
  ParticleFrame particles = ball(Vec3(0, std::numeric_limits<double>::infinity(), 0), 1);
  EXPECT_THROW(renderer.draw(particles), InputError);
  EXPECT_THROW(renderer.draw(ball(Vec3::Zero(), 0)), InputError);
  particles = ball(Vec3::Zero(), 1);
  particles.colors.clear();
  EXPECT_THROW(renderer.draw(particles), InputError);
}

TEST(Render, OddNumbersInAFrameDoNoHarm) {
  // Zero normals and texture coordinates that are not finite: drawn, without a crash.
  SurfaceFrame frame = square(1);
  frame.normals.assign(4, Vec3::Zero());
  frame.corner_uvs[0][0] = Vec2f(std::numeric_limits<float>::quiet_NaN(), 1e30f);
  const Image image = Renderer(front_view(16, 16), {}, flat_image({90, 90, 90}), unit_box).draw(frame);
  EXPECT_EQ(image.pixels.size(), 256u);
}

TEST(Render, BadSettingsAreRefused) {
  const auto refused = [](auto change) {
    scenes::RenderSpec spec = front_view(16, 16);
    change(spec);
    EXPECT_THROW(Renderer(spec, {}, {}, unit_box), InputError);
  };
  refused([](auto& spec) { spec.width = 0; });
  refused([](auto& spec) { spec.samples = 0; });
  refused([](auto& spec) { spec.exposure = 0; });
  refused([](auto& spec) { spec.style = "glass"; });
  refused([](auto& spec) { spec.light_direction = Vec3::Zero(); });
  refused([](auto& spec) { spec.light_size = -1; });
  refused([](auto& spec) { spec.camera.vertical_fov = 0; });
  refused([](auto& spec) { spec.camera.look_at = spec.camera.position; });
  scenes::BoundarySpec wall = floor_wall(1, 0);
  wall.boundary.mesh.triangles[0][0] = 99;
  EXPECT_THROW(Renderer(front_view(16, 16), {wall}, {}, unit_box), InputError);
}

}  // namespace
}  // namespace flowskin::tools::render_test
