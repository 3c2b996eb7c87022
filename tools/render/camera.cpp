#include "tools/render/camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/errors.h"

namespace flowskin::tools {
namespace {

// Half the height of the picture at distance 1.
double half_height(const scenes::CameraSpec& spec) {
  if (!(spec.vertical_fov >= 1 && spec.vertical_fov <= 170)) {
    throw InputError(fmt::format("render.camera.vertical_fov is {}: expected 1 to 170 degrees", spec.vertical_fov));
  }
  return std::tan(spec.vertical_fov * std::numbers::pi / 360);
}

struct View {
  Vec3 right, up, forward;
};

View view_along(const Vec3& forward, const Vec3& wanted_up) {
  View view;
  view.forward = forward.normalized();
  Vec3 up = wanted_up.normalized();
  // Looking along the up direction: any other one will do.
  if (!(view.forward.cross(up).norm() > 1e-6)) up = std::abs(view.forward.z()) < 0.9 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  view.right = view.forward.cross(up).normalized();
  view.up = view.right.cross(view.forward);
  return view;
}

// Moves a camera at depth z0 sideways until what it sees is in the middle of the picture.
Eigen::Array2d centered(const std::vector<Vec3>& points, const View& view, Eigen::Array2d center, double z0,
                        double middle) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 10; ++iteration) {
    Eigen::Array2d low = Eigen::Array2d::Constant(infinity), high = -low;
    for (const Vec3& point : points) {
      const Eigen::Array2d across(point.dot(view.right), point.dot(view.up));
      const Eigen::Array2d slope = (across - center) / std::max(point.dot(view.forward) - z0, 1e-9);
      low = low.min(slope);
      high = high.max(slope);
    }
    center += (low + high) / 2 * (middle - z0);
  }
  return center;
}

}  // namespace

Camera::Camera(const scenes::CameraSpec& spec, int width, int height, const Vec3& origin)
    : origin_(origin), exact_position_(spec.position), center_(float(width) / 2, float(height) / 2) {
  const Vec3 forward = spec.look_at - spec.position;
  if (!forward.allFinite() || !spec.up.allFinite() || !(forward.norm() > 0)) {
    throw InputError("render.camera: position and look_at must be finite and differ");
  }
  const View view = view_along(forward, spec.up);
  right_ = view.right;
  up_ = view.up;
  forward_ = view.forward;
  pixels_per_slope_ = height / 2.0 / half_height(spec);
  position_ = (spec.position - origin).cast<float>();
  const Vec3 step_x = right_ / pixels_per_slope_, step_y = -up_ / pixels_per_slope_;
  corner_ = (forward_ - step_x * (width / 2.0) - step_y * (height / 2.0)).cast<float>();
  step_x_ = step_x.cast<float>();
  step_y_ = step_y.cast<float>();
}

Vec2f Camera::project(const Vec3& point) const {
  const Vec3 relative = point - exact_position_;
  const double depth = relative.dot(forward_);
  return center_ + Vec2f(float(pixels_per_slope_ * relative.dot(right_) / depth),
                         float(-pixels_per_slope_ * relative.dot(up_) / depth));
}

scenes::CameraSpec place_camera(const scenes::CameraSpec& spec, double aspect, const std::vector<Vec3>& points) {
  if (!spec.position.isZero(0)) return spec;
  constexpr double margin = 1.12, infinity = std::numeric_limits<double>::infinity();
  const double slope_y = half_height(spec) / margin, slope_x = slope_y * aspect;
  const View view = view_along(Vec3(-0.55, -0.5, -1), spec.up);
  scenes::CameraSpec placed = spec;
  if (points.empty()) {
    placed.position = -5 * view.forward;
    placed.look_at = Vec3::Zero();
    return placed;
  }
  // In the camera's axes a point is in view where |x - x0| <= slope_x (z - z0), and alike for y: for each side of the
  // picture, the point lying farthest out counts. The pair of sides that is tighter decides how near the camera can be.
  Eigen::Array2d outer = Eigen::Array2d::Constant(-infinity), inner = outer;
  const Eigen::Array2d slope(slope_x, slope_y);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) {
    const Eigen::Array2d across(point.dot(view.right), point.dot(view.up));
    const double z = point.dot(view.forward);
    outer = outer.max(across - slope * z);
    inner = inner.max(-across - slope * z);
    sum += point;
  }
  const double middle = sum.dot(view.forward) / double(points.size());
  double z0 = -((outer + inner) / (2 * slope)).maxCoeff();
  if (!(middle - z0 > 1e-9)) z0 = middle - 1;  // all points coincide: stand back by a metre
  const Eigen::Array2d center = centered(points, view, (outer - inner) / 2, z0, middle);
  placed.position = center.x() * view.right + center.y() * view.up + z0 * view.forward;
  placed.look_at = placed.position + (middle - z0) * view.forward;
  return placed;
}

}  // namespace flowskin::tools
