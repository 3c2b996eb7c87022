// Stretched textures: shares against closed forms, generations against what must not jump.
#include "tools/textures/texture_generations.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <map>

#include "common/errors.h"
#include "scenes/io/frame_files.h"
#include "scenes/io/ply_reader.h"
#include "tests/tools/io_fixture.h"
#include "tests/tracking/mesh_test_shapes.h"

namespace flowskin::tools::texture_generations_test {
namespace {

/// The unit cube, n by n squares per face, faces not joined; `sheared` along x by `shear` times y.
tracking::SurfaceMesh sheared_cube(int n, double shear) {
  tracking::SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 1.0}) {
      const int first = static_cast<int>(mesh.positions.size());
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          Vec3 x;
          x[axis] = side;
          x[(axis + 1) % 3] = double(i) / n;
          x[(axis + 2) % 3] = double(j) / n;
          mesh.rest_positions.push_back(x);
          mesh.positions.push_back(x + Vec3(shear * x.y(), 0, 0));
          mesh.ids.push_back(mesh.next_id++);
        }
      tracking::test::add_grid_triangles(first, n, mesh.triangles);
    }
  return mesh;
}

TEST(StretchBlend, RisesFromTheLimitToHalfAsMuchAgain) {
  EXPECT_EQ(blend_at(1, 4), 0);
  EXPECT_EQ(blend_at(4, 4), 0);
  EXPECT_NEAR(blend_at(4 * std::sqrt(1.5), 4), 0.5, 1e-12);
  EXPECT_LT(blend_at(5.9, 4), 1);
  EXPECT_EQ(blend_at(6.0001, 4), 1);
  EXPECT_EQ(blend_at(INFINITY, 4), 1);
}

TEST(StretchBlend, OfAShearedCube) {
  // Faces across z: distortion (sqrt(g^2 + 4) + g) / 2, area 1. Across x: sqrt(1 + g^2), which is their area too.
  // Across y: undistorted, area 1.
  const double shear = 4, across_z = (std::sqrt(20.0) + 4) / 2, across_x = std::sqrt(17.0);
  const tracking::SurfaceMesh mesh = sheared_cube(4, shear);
  const double area = 2 * (2 + across_x);
  EXPECT_NEAR(overstretched_share(mesh, mesh.rest_positions, 4.2), 2 / area, 1e-12);
  EXPECT_NEAR(overstretched_share(mesh, mesh.rest_positions, 4), (2 + 2 * across_x) / area, 1e-12);
  EXPECT_EQ(overstretched_share(mesh, mesh.rest_positions, 4.3), 0);
  EXPECT_NEAR(overstretched_share(mesh, mesh.rest_positions, 4.2, std::vector<double>(mesh.ids.size(), 0.25)),
              0.5 / area, 1e-12);
  const std::vector<double> blend = stretch_blend(mesh, mesh.rest_positions, 3);
  for (std::size_t v = 0; v < blend.size(); ++v) {
    const std::size_t axis = v / 50;
    const double expected = axis == 0 ? blend_at(across_x, 3) : axis == 1 ? 0 : blend_at(across_z, 3);
    EXPECT_NEAR(blend[v], expected, 1e-12) << v;
  }
}

TEST(StretchBlend, OneBadTriangleDoesNotShow) {
  tracking::SurfaceMesh mesh = sheared_cube(8, 0);
  mesh.rest_positions[mesh.triangles[60][0]] = mesh.rest_positions[mesh.triangles[60][1]];
  EXPECT_GT(overstretched_share(mesh, mesh.rest_positions, 4), 0);
  for (const double share : stretch_blend(mesh, mesh.rest_positions, 4)) EXPECT_EQ(share, 0);
}

TEST(FollowingWeights, AreLimitedInSpeedAndKnowVerticesById) {
  tracking::SurfaceMesh mesh = sheared_cube(2, 0);
  const std::size_t count = mesh.ids.size();
  FollowingWeights weights;
  weights.reset(mesh);
  EXPECT_EQ(weights.follow(mesh, std::vector<double>(count, 1), 0.3), std::vector<double>(count, 0.3));
  EXPECT_EQ(weights.follow(mesh, std::vector<double>(count, 0.4), 0.3), std::vector<double>(count, 0.4));
  // A vertex without a past begins with its neighbours' weight, in whatever order the vertices stand.
  std::swap(mesh.ids[0], mesh.ids[5]);
  mesh.ids[4] = 1000;
  for (const double weight : weights.follow(mesh, std::vector<double>(count, 1), 0.3)) EXPECT_NEAR(weight, 0.7, 1e-12);
  for (std::uint64_t& id : mesh.ids) id += 2000;  // nothing is known
  EXPECT_EQ(weights.follow(mesh, std::vector<double>(count, 0.9), 0.3), std::vector<double>(count, 0.9));
}

/// A ball of particles in a simple shear x' = rate y.
class ShearedBall {
 public:
  static constexpr double rate = 1;       // 1/s
  static constexpr double spacing = 0.1;  // m
  static constexpr double step = 0.15;    // s, between frames
  ShearedBall() {
    for (int i = -5; i <= 5; ++i)
      for (int j = -5; j <= 5; ++j)
        for (int k = -5; k <= 5; ++k)
          if (i * i + j * j + k * k <= 25) start_.emplace_back(spacing * i, spacing * j, spacing * k);
  }
  tracking::Particles at(double time) const {
    tracking::Particles particles;
    particles.time = time;
    particles.rest_positions = start_;
    for (const Vec3& x : start_) {
      particles.ids.push_back(particles.ids.size());
      particles.positions.emplace_back(x + Vec3(rate * time * x.y(), 0, 0));
      particles.velocities.emplace_back(rate * x.y(), 0, 0);
    }
    return particles;
  }
  tracking::Tracker tracker(bool fairing_drags = false) const {
    tracking::TrackerSettings settings;
    settings.spacing = spacing;
    settings.velocity = "hybrid";
    settings.fairing_drags = fairing_drags;
    return {settings, at(0)};
  }

 private:
  std::vector<Vec3> start_;
};

scenes::TextureSpec texture_that(const std::string& when_stretched) {
  scenes::TextureSpec texture;
  texture.mapping = "planar";  // coordinates are then a function of the place alone
  texture.axis = {0, 0, 1};
  texture.when_stretched = when_stretched;
  texture.stretch_limit = 1.5;
  return texture;
}

/// Runs the ball and shows each frame with the tracker's mesh.
template <class Visit>
void run_sheared_ball(const std::string& when_stretched, int frames, Visit visit, bool fairing_drags = false) {
  const ShearedBall ball;
  tracking::Tracker tracker = ball.tracker(fairing_drags);
  TextureGenerations generations(texture_that(when_stretched), rest_frame(ball.at(0).positions));
  for (int frame = 0; frame <= frames; ++frame) {
    tracking::Particles particles = ball.at(ShearedBall::step * frame);
    generations.carry(particles);
    if (frame > 0) tracker.advance(particles);
    generations.update(tracker, particles, frame > 0 ? ShearedBall::step : 0);
    visit(generations.dress(tracker.mesh(), particles.time), generations, tracker);
  }
}

TEST(TextureGenerations, LeaveChangesNothing) {
  run_sheared_ball("leave", 6, [](const SurfaceFrame& frame, const TextureGenerations& generations, const auto&) {
    EXPECT_TRUE(frame.texture_blend.empty() && frame.vertex_uvs2.empty() && frame.corner_uvs2.empty());
    EXPECT_TRUE(frame.mesh.layers.empty());
    EXPECT_EQ(generations.overstretched(), overstretched_share(frame.mesh, frame.mesh.rest_positions, 1.5));
  });
}

TEST(TextureGenerations, SolidHasWeightsOnly) {
  double largest = 0;
  run_sheared_ball("solid", 16, [&](const SurfaceFrame& frame, const TextureGenerations& generations, const auto&) {
    ASSERT_EQ(frame.texture_blend.size(), frame.mesh.positions.size());
    EXPECT_TRUE(frame.vertex_uvs2.empty() && frame.corner_uvs2.empty() && frame.mesh.layers.empty());
    for (const float weight : frame.texture_blend) largest = std::max<double>(largest, weight);
    EXPECT_LE(generations.overstretched(), overstretched_share(frame.mesh, frame.mesh.rest_positions, 1.5));
  });
  EXPECT_GT(largest, 0.5);
}

TEST(TextureGenerations, TheSecondSetIsTheMappingOfTheMomentInWhichItBegan) {
  double began = -1, errors = 0;
  int checked = 0, before = 1;
  RestFrame rest;
  run_sheared_ball("fade", 10, [&](const SurfaceFrame& frame, const TextureGenerations& generations, const auto&) {
    if (generations.generations() == 1) {
      EXPECT_LE(generations.overstretched(), 0.05);
      EXPECT_EQ(frame.vertex_uvs, frame.vertex_uvs2);
      return;
    }
    if (before == 1) {
      began = frame.time;
      rest = rest_frame(frame.mesh.positions);
      rest.size = 1;  // of the ball at rest
    }
    before = generations.generations();
    if (before > 2) return;
    // Planar along z, two tiles across the ball; the material was at x - rate (t - began) y.
    for (std::size_t v = 0; v < frame.vertex_uvs2.size(); ++v) {
      const Vec3& x = frame.mesh.positions[v];
      const Vec3 then = x - Vec3(ShearedBall::rate * (frame.time - began) * x.y(), 0, 0) - rest.center;
      errors += (frame.vertex_uvs2[v].cast<double>() - 2 * Eigen::Vector2d(then.x(), then.y())).squaredNorm();
      ++checked;
    }
  });
  // The distortion of a shear g is 1.5 at g = 5/6 in the planes across z, and less in others.
  EXPECT_GT(began, 5.0 / 6);
  EXPECT_LT(began, 1.3);
  ASSERT_GT(checked, 1000);
  EXPECT_LT(std::sqrt(errors / checked), 2 * 0.25 * 0.075);  // tiles; a quarter of an edge
}

TEST(TextureGenerations, NothingThatShowsJumps) {
  struct Shown {
    Vec2f first, second;
    float share = 0;
  };
  const auto share_of = [](const Shown& shown, const Vec2f& uv) {
    return (shown.first == uv ? 1 - shown.share : 0) + (shown.second == uv ? shown.share : 0);
  };
  std::map<std::uint64_t, Shown> last;
  int generations_seen = 1, promoted = 0;
  const double most = ShearedBall::step / 0.5 + 1e-6;
  run_sheared_ball(
      "fade", 40,
      [&](const SurfaceFrame& frame, const TextureGenerations& generations, const auto& tracker) {
        EXPECT_LE(tracker.mesh().layers.size(), 2U);
        std::map<std::uint64_t, Shown> now;
        int kept = 0;
        for (std::size_t v = 0; v < frame.mesh.ids.size(); ++v) {
          const Shown shown{frame.vertex_uvs[v], frame.vertex_uvs2[v], frame.texture_blend[v]};
          now[frame.mesh.ids[v]] = shown;
          const auto found = last.find(frame.mesh.ids[v]);
          if (found == last.end()) continue;
          const Shown& before = found->second;
          // A vertex of a replaced region may have slid: it shows the texture of its new place.
          const bool has_stayed = shown.first == before.first && shown.second == before.second;
          const bool took_over = shown.first == before.second;
          const bool one_began = shown.first == before.first && before.first == before.second;
          if (!has_stayed && !took_over && !one_began) continue;
          ++kept;
          ASSERT_NEAR(share_of(shown, before.first), share_of(before, before.first), most) << frame.time;
          ASSERT_NEAR(share_of(shown, before.second), share_of(before, before.second), most) << frame.time;
          promoted += before.first != shown.first;
        }
        EXPECT_TRUE(last.empty() || kept > 0.8 * double(now.size())) << kept << " of " << now.size();
        last = std::move(now);
        generations_seen = generations.generations();
      },
      // A vertex that slides shows another place of the image.
      true);
  EXPECT_GE(generations_seen, 3);
  EXPECT_GT(promoted, 100);
}

TEST(TextureGenerations, FadingKeepsTheStretchThatShowsBelowThatOfTheRestPositions) {
  double with = 0, without = 0;
  run_sheared_ball("fade", 40, [&](const SurfaceFrame& frame, const TextureGenerations& generations, const auto&) {
    with = generations.overstretched();
    without = overstretched_share(frame.mesh, frame.mesh.rest_positions, 1.5);
  });
  EXPECT_GT(without, 0.6);
  EXPECT_LT(with, 0.5 * without);
}

TEST(TextureGenerations, AreTheSameAtAnyThreadCount) {
  std::vector<SurfaceFrame> ends;
  const int threads = omp_get_max_threads();
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    run_sheared_ball("fade", 14, [&](const SurfaceFrame& frame, const TextureGenerations&, const auto&) {
      if (frame.time > 13.5 * ShearedBall::step) ends.push_back(frame);
    });
  }
  omp_set_num_threads(threads);
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].texture_blend, ends[1].texture_blend);
  EXPECT_EQ(ends[0].corner_uvs, ends[1].corner_uvs);
  EXPECT_EQ(ends[0].corner_uvs2, ends[1].corner_uvs2);
}

TEST(TextureGenerations, LateParticlesContinueTheirMotionBackwards) {
  const ShearedBall ball;
  tracking::Tracker tracker = ball.tracker();
  scenes::TextureSpec texture = texture_that("fade");
  texture.stretch_limit = 1.01;
  TextureGenerations generations(texture, rest_frame(ball.at(0).positions));
  tracking::Particles particles = ball.at(0.3);
  tracker.advance(particles);
  generations.update(tracker, particles, 0.3);
  ASSERT_EQ(generations.generations(), 2);
  for (const double time : {0.5, 0.7}) {
    particles = ball.at(time);
    particles.ids.push_back(particles.ids.size());
    particles.positions.emplace_back(time, 2, 0);
    particles.velocities.emplace_back(1, 0, 0);
    generations.carry(particles);
    ASSERT_EQ(particles.layers.at(0).size(), particles.ids.size());
    EXPECT_EQ(particles.layers[0].front(), ball.at(0.3).positions.front());
    EXPECT_LT((particles.layers[0].back() - Vec3(0.3, 2, 0)).norm(), 1e-12);
  }
  particles.has_lasting_ids = false;
  generations.carry(particles);
  EXPECT_TRUE(particles.layers.at(0).empty());
}

template <class State>
std::size_t bytes_saved(const State& state) {
  std::size_t size = 0;
  StateWriter writer([&](std::string_view bytes) { size += bytes.size(); });
  writer(state);
  writer.flush();
  return size;
}

TEST(TextureGenerations, ForgetParticlesThatAreGone) {
  const ShearedBall ball;
  tracking::Tracker tracker = ball.tracker();
  scenes::TextureSpec texture = texture_that("fade");
  texture.stretch_limit = 1.01;
  TextureGenerations generations(texture, rest_frame(ball.at(0).positions));
  tracking::Particles particles = ball.at(0.3);
  tracker.advance(particles);
  generations.update(tracker, particles, 0.3);
  ASSERT_EQ(generations.generations(), 2);
  // A jet of 20 particles a step, drained in the next one.
  std::size_t first = 0;
  for (int step = 0; step < 50; ++step) {
    particles = ball.at(0.3 + 0.01 * step);
    for (int i = 0; i < 20; ++i) {
      particles.ids.push_back(10000 + std::uint64_t(20 * step + i));
      particles.positions.emplace_back(0.1 * i, 2, 0);
      particles.velocities.emplace_back(1, 0, 0);
    }
    generations.carry(particles);
    if (step == 0) first = bytes_saved(generations);
    EXPECT_EQ(bytes_saved(generations), first) << step;
    EXPECT_EQ(particles.layers.at(0).front(), ball.at(0.3).positions.front());
  }
}

// ---------------------------------------------------------------- files

class TextureBlendFiles : public IoTest {};

SurfaceFrame blended_frame() {
  SurfaceFrame frame = sphere_frame(2);
  for (std::size_t v = 0; v < frame.mesh.positions.size(); ++v) {
    frame.texture_blend.push_back(1.0F / static_cast<float>(v + 1));
    frame.vertex_uvs2.emplace_back(0.1F * static_cast<float>(v), -frame.vertex_uvs[v].x());
  }
  for (const auto& corners : frame.corner_uvs) frame.corner_uvs2.push_back({corners[2], -corners[0], corners[1]});
  return frame;
}

TEST_F(TextureBlendFiles, PlyBringsBackWeightsAndBothSets) {
  const SurfaceFrame frame = blended_frame();
  scenes::write_surface_ply(path("a.ply"), frame);
  SurfaceFrame back = sphere_frame(2);
  back.corner_uvs.clear();
  scenes::read_surface_blend(path("a.ply"), back);
  EXPECT_EQ(back.texture_blend, frame.texture_blend);
  EXPECT_EQ(back.corner_uvs, frame.corner_uvs);
  EXPECT_EQ(back.corner_uvs2, frame.corner_uvs2);
  const scenes::PlyFile ply = scenes::read_ply(path("a.ply"));
  for (std::size_t v = 0; v < ply.vertex_count; ++v) {
    EXPECT_EQ(ply.vertex.at("s2")[v], frame.vertex_uvs2[v].x());
    EXPECT_EQ(ply.vertex.at("t2")[v], frame.vertex_uvs2[v].y());
    EXPECT_EQ(ply.vertex.at("texture_u2")[v], frame.vertex_uvs2[v].x());
    EXPECT_EQ(ply.vertex.at("texture_v2")[v], frame.vertex_uvs2[v].y());
    EXPECT_EQ(ply.vertex.at("id")[v], static_cast<double>(frame.mesh.ids[v]));
  }
  EXPECT_EQ(scenes::read_surface_ply(path("a.ply")).triangles, frame.mesh.triangles);
}

TEST_F(TextureBlendFiles, PlyWithWeightsOnlyAndWithNothing) {
  SurfaceFrame frame = blended_frame();
  frame.vertex_uvs2.clear();
  frame.corner_uvs2.clear();
  scenes::write_surface_ply(path("a.ply"), frame);
  SurfaceFrame back;
  scenes::read_surface_blend(path("a.ply"), back);
  EXPECT_EQ(back.texture_blend, frame.texture_blend);
  EXPECT_TRUE(back.corner_uvs.empty() && back.corner_uvs2.empty());
  scenes::write_surface_ply(path("b.ply"), sphere_frame(2));
  SurfaceFrame nothing;
  scenes::read_surface_blend(path("b.ply"), nothing);
  EXPECT_TRUE(nothing.texture_blend.empty() && nothing.corner_uvs2.empty());
}

TEST_F(TextureBlendFiles, BadWeightsAndCoordinatesAreNotWritten) {
  const auto message = [&](auto spoil) {
    SurfaceFrame frame = blended_frame();
    spoil(frame);
    return message_of<RunError>([&] { scenes::write_surface_ply(path("a.ply"), frame); });
  };
  const auto expect = [&](const std::string& text, auto spoil) {
    EXPECT_NE(message(spoil).find(text), std::string::npos) << message(spoil);
  };
  expect("blend weight is not between 0 and 1", [](SurfaceFrame& f) { f.texture_blend[3] = 1.5F; });
  expect("blend weight is not between 0 and 1", [](SurfaceFrame& f) { f.texture_blend[3] = NAN; });
  expect("0 texture blend weights", [](SurfaceFrame& f) { f.texture_blend.clear(); });
  expect("second texture coordinates", [](SurfaceFrame& f) { f.vertex_uvs2.pop_back(); });
  expect("second texture coordinates", [](SurfaceFrame& f) { f.corner_uvs2.pop_back(); });
  expect("of triangle 2 are not finite", [](SurfaceFrame& f) { f.corner_uvs2[2][1].x() = NAN; });
  EXPECT_EQ(files_in_folder(), 0U);
}

}  // namespace
}  // namespace flowskin::tools::texture_generations_test
