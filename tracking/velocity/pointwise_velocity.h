// Base of the methods that look at one vertex at a time.
#pragma once

#include "tracking/velocity/surface_point.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {

/// Evaluates the jet at every vertex, in parallel, and leaves the rest to `velocity`.
class PointwiseVelocity : public VelocityMethod {
 public:
  void evaluate(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const final;
  /// Velocity in effective radii per second; only called where the point is defined.
  virtual Vec3 velocity(const SurfacePoint& point) const = 0;
};

}  // namespace flowskin::tracking
