// The normal velocity [FMM13, Eq. 4].
#include "tracking/velocity/methods.h"
#include "tracking/velocity/pointwise_velocity.h"

namespace flowskin::tracking {
namespace {

class NormalVelocity final : public PointwiseVelocity {
 public:
  Vec3 velocity(const SurfacePoint& point) const override { return point.normal_velocity; }
};

}  // namespace

VelocityMethodInfo normal_velocity_info() {
  return {"normal",
          "Follows the surface along its normal only; the shape is right, whatever it carries is left behind.",
          []() -> std::unique_ptr<VelocityMethod> { return std::make_unique<NormalVelocity>(); }};
}

}  // namespace flowskin::tracking
