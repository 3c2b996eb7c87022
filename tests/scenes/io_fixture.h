// A folder that goes away, and small frames with awkward numbers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "scenes/io/frames.h"

namespace flowskin::scenes {

/// Gives each test an empty folder of its own.
class IoTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("flowskin-" + std::to_string(::getpid()) + "-" + info->test_suite_name() + "-" + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  std::string write_text(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name).string();
  }
  static std::string read_text(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

/// Runs `action` and returns the message of the Error it throws; fails the test where it throws none.
template <class Error, class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "an error of another kind: " << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// A sphere made by splitting an octahedron `level` times: closed, outward.
inline tracking::SurfaceMesh sphere_mesh(int level, const Vec3& center = Vec3::Zero(), double radius = 1) {
  tracking::SurfaceMesh mesh;
  std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < level; ++k) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back((points[a] + points[b]).normalized());
      return found->second;
    };
    std::vector<tracking::Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.rest_positions.push_back(center + radius * points[i]);
    mesh.positions.push_back(mesh.rest_positions.back() + Vec3(0.1, -1.0 / 3, 1e-7));
    mesh.velocities.push_back(Vec3(1.0 / 7, -2.5e-9, 1e5) * static_cast<double>(i + 1));
    mesh.ids.push_back(3 * i + 1);
  }
  mesh.next_id = 3 * points.size() + 5;
  return mesh;
}

/// One chart of the texture, or six as on a box: then corners at the same vertex may have unequal coordinates.
enum class Charts { one, six };

/// A sphere with normals, colours and texture coordinates.
inline SurfaceFrame sphere_frame(int level = 2, Charts charts = Charts::six) {
  SurfaceFrame frame;
  frame.time = 0.1;
  frame.mesh = sphere_mesh(level);
  const auto uv = [](const Vec3& x, int axis) {
    return Vec2f(static_cast<float>(0.37 * x[(axis + 1) % 3] + 0.1), static_cast<float>(0.37 * x[(axis + 2) % 3]));
  };
  for (const Vec3& x : frame.mesh.rest_positions) {
    frame.normals.push_back(x.normalized());
    frame.vertex_uvs.push_back(uv(x, 2));
    const Vec3 color = (127.5 * (x + Vec3::Ones())).cwiseMax(0).cwiseMin(255);
    frame.colors.push_back({std::uint8_t(color.x()), std::uint8_t(color.y()), std::uint8_t(color.z())});
  }
  for (const Triangle& triangle : frame.mesh.triangles) {
    const auto corner = [&](int k) -> const Vec3& { return frame.mesh.rest_positions[triangle[k]]; };
    int axis = 2;
    if (charts == Charts::six) (corner(0) + corner(1) + corner(2)).cwiseAbs().maxCoeff(&axis);
    frame.corner_uvs.push_back({uv(corner(0), axis), uv(corner(1), axis), uv(corner(2), axis)});
  }
  return frame;
}

inline ParticleFrame particle_frame(int count) {
  ParticleFrame frame;
  frame.radius = 0.01;
  ParticleState& state = frame.state;
  state.time = 1.0 / 3;
  for (int i = 0; i < count; ++i) {
    state.ids.push_back(static_cast<std::uint64_t>(2 * i + 7));
    state.positions.emplace_back(0.1 * i, std::sin(i), -1e-6 * i);
    state.velocities.emplace_back(std::cos(i), -0.0, 1.0 / (i + 1));
    state.rest_positions.emplace_back(0.1 * i, 1.0 / 3, 0.7);
    state.densities.push_back(1000 + i / 7.0);
    frame.colors.push_back({std::uint8_t(7 * i), std::uint8_t(3 * i + 1), std::uint8_t(255 - i)});
  }
  return frame;
}

}  // namespace flowskin::scenes
