// Embree behind two questions: what does a ray meet first, and is the way free?
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// Embree wants denormal numbers flushed to zero while it traces; the thread's setting is put back at the end, so that
/// the simulation computes the same whether pictures are made or not.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

struct RayHit {
  float distance = std::numeric_limits<float>::infinity();
  Vec3f normal{0, 0, 0};  ///< Geometric; unit
  float u = 0, v = 0;     ///< Barycentric coordinates of a triangle's second and third corner.
  unsigned geometry = 0;  ///< In the order of adding.
  unsigned primitive = 0;
};

/// The Embree device. One build thread, so that trees, and with them ties between triangles, are always the same.
class TraceDevice {
 public:
  /// @throws RunError
  TraceDevice();
  RTCDevice get() const { return device_.get(); }
  /// @throws RunError saying what failed, where Embree has reported an error.
  void check(const char* what) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
};

/// Geometry to trace. Fill, commit, then ask from any thread.
class TraceScene {
 public:
  /// @throws RunError
  explicit TraceScene(const TraceDevice& device);

  /// @throws RunError where memory runs out. Indices must be valid, numbers finite.
  void add_triangles(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles);
  void add_balls(const std::vector<Vec3f>& centers, float radius);
  void commit();

  /// The nearest hit within (near, far), if any.
  bool intersect(const Vec3f& origin, const Vec3f& direction, float near, float far, RayHit& hit) const;
  /// True where anything lies within (near, far).
  bool occluded(const Vec3f& origin, const Vec3f& direction, float near, float far) const;

 private:
  bool meets_box(const Vec3f& origin, const Vec3f& direction, float far) const;
  void attach(RTCGeometry geometry);

  struct Release {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  const TraceDevice* device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
  Vec3f box_min_ = Vec3f::Zero(), box_max_ = Vec3f::Zero();
};

}  // namespace flowskin::tools
