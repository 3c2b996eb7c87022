#include "tracking/velocity/pointwise_velocity.h"

#include "tracking/field/neighborhoods.h"

namespace flowskin::tracking {

void PointwiseVelocity::evaluate(const ImplicitField& field, const MeshAdjacency& /*topology*/,
                                 const std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const {
  velocities.resize(positions.size());
  const FieldScale scale = field.scale();
  Neighborhoods(field, positions).for_each([&](int i, const LocalField& local) {
    const SurfacePoint point(local.motion_jet(positions[i]), scale);
    Vec3 result = Vec3::Zero();
    if (point.defined) result = scale.length * velocity(point);
    velocities[i] = result.allFinite() ? result : Vec3(Vec3::Zero());
  });
}

}  // namespace flowskin::tracking
