// The pinhole camera, and where to put it when the scene does not say.
#pragma once

#include <vector>

#include "scenes/scene.h"
#include "tools/frame_data.h"

namespace flowskin::tools {

/// A pinhole camera over a picture of width x height pixels; pixel (0, 0) is at the top left.
class Camera {
 public:
  /// `origin` is subtracted from all positions, so that single precision suffices far from zero.
  /// @throws InputError where the view is impossible: no direction, or an angle outside of 1 to 170 degrees.
  Camera(const scenes::CameraSpec& spec, int width, int height, const Vec3& origin);

  const Vec3f& position() const { return position_; }
  /// Unit direction through a point of the picture, in pixels from the top left corner.
  Vec3f direction(float x, float y) const { return (corner_ + x * step_x_ + y * step_y_).normalized(); }
  /// Pixels from the top left corner at which a point (m) appears; it must lie in front of the camera.
  Vec2f project(const Vec3& point) const;
  /// Solid angle of a pixel in the middle of the picture (sr).
  float pixel_solid_angle() const { return step_x_.norm() * step_y_.norm(); }

 private:
  Vec3 origin_, exact_position_, right_, up_, forward_;
  double pixels_per_slope_;
  Vec2f center_;
  Vec3f position_, corner_, step_x_, step_y_;
};

/// The camera of a scene that names none (position all zero): obliquely from above, as near as shows all `points`
/// with a margin. A camera with a position is returned as it is.
scenes::CameraSpec place_camera(const scenes::CameraSpec& spec, double aspect, const std::vector<Vec3>& points);

}  // namespace flowskin::tools
