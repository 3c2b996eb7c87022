#include "tracking/velocity/pointwise_velocity.h"

#include <cstddef>

namespace flowskin::tracking {

void PointwiseVelocity::evaluate(const MetaballField& field, const MeshTopology& /*topology*/,
                                 const std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const {
  velocities.resize(positions.size());
  const FieldSettings& settings = field.settings();
  const auto count = static_cast<std::ptrdiff_t>(positions.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const SurfacePoint point(field.jet(positions[i]), settings);
    Vec3 result = Vec3::Zero();
    if (point.defined) result = settings.radius * velocity(point);
    velocities[i] = result.allFinite() ? result : Vec3(Vec3::Zero());
  }
}

}  // namespace flowskin::tracking
