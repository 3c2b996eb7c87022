#include "tools/render/trace_scene.h"

#include <fmt/format.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cmath>

#include "common/errors.h"

namespace flowskin::tools {

#if defined(__SSE__)
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | 0x8040u);  // flush to zero (bit 15), denormals are zero (bit 6)
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

TraceDevice::TraceDevice() : device_(rtcNewDevice("threads=1,user_threads=0")) {
  if (!device_) {
    throw RunError(fmt::format("Embree does not start (error {}): no pictures can be made on this machine",
                               int(rtcGetDeviceError(nullptr))));
  }
}

void TraceDevice::check(const char* what) const {
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error == RTC_ERROR_NONE) return;
  const char* reason = error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "internal error";
  throw RunError(fmt::format("Embree failed at {}: {} ({})", what, reason, int(error)));
}

TraceScene::TraceScene(const TraceDevice& device) : device_(&device), scene_(rtcNewScene(device.get())) {
  device.check("making a scene");
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
}

void TraceScene::attach(RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  device_->check("adding a geometry");
}

void TraceScene::add_triangles(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles) {
  RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), positions.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles.size()));
  if (vertices != nullptr && indices != nullptr) {
    for (const Vec3f& position : positions) vertices = std::copy_n(position.data(), 3, vertices);
    for (const auto& triangle : triangles) {
      for (const int corner : triangle) *indices++ = unsigned(corner);
    }
  }
  attach(geometry);
}

void TraceScene::add_balls(const std::vector<Vec3f>& centers, float radius) {
  RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* balls = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                            4 * sizeof(float), centers.size()));
  if (balls != nullptr) {
    for (const Vec3f& center : centers) {
      balls = std::copy_n(center.data(), 3, balls);
      *balls++ = radius;
    }
  }
  attach(geometry);
}

void TraceScene::commit() {
  rtcCommitScene(scene_.get());
  device_->check("building the tree of a frame");
  RTCBounds bounds;
  rtcGetSceneBounds(scene_.get(), &bounds);
  box_min_ = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
  box_max_ = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
}

// Most rays miss the fluid by far: this spares them the call.
bool TraceScene::meets_box(const Vec3f& origin, const Vec3f& direction, float far) const {
  if (!(box_min_.x() <= box_max_.x())) return false;  // nothing in it
  const Vec3f inverse = direction.cwiseInverse();
  const Vec3f a = (box_min_ - origin).cwiseProduct(inverse), b = (box_max_ - origin).cwiseProduct(inverse);
  // In this order std::min and std::max skip the NaN of 0 * infinity (a ray within a side of the box).
  float enter = 0, leave = far;
  for (int i = 0; i < 3; ++i) {
    enter = std::max(enter, std::min(a[i], b[i]));
    leave = std::min(leave, std::max(a[i], b[i]));
  }
  return enter <= leave * 1.00001f;
}

bool TraceScene::intersect(const Vec3f& origin, const Vec3f& direction, float near, float far, RayHit& hit) const {
  if (!meets_box(origin, direction, far)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = origin.x();
  query.ray.org_y = origin.y();
  query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tnear = near;
  query.ray.tfar = far;
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.distance = query.ray.tfar;
  hit.normal = Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  hit.geometry = query.hit.geomID;
  hit.primitive = query.hit.primID;
  return true;
}

bool TraceScene::occluded(const Vec3f& origin, const Vec3f& direction, float near, float far) const {
  if (!meets_box(origin, direction, far)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = ~0u;
  rtcOccluded1(scene_.get(), &context, &ray);
  return ray.tfar < 0;  // Embree's sign of a blocked ray: minus infinity.
}

}  // namespace flowskin::tools
