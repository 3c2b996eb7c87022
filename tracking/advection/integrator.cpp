#include "tracking/advection/integrator.h"

namespace flowskin::tracking {
namespace {

std::vector<Vec3> moved(const std::vector<Vec3>& positions, double step, const std::vector<Vec3>& velocities) {
  std::vector<Vec3> result(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) result[v] = positions[v] + step * velocities[v];
  return result;
}

}  // namespace

void advect_step(const VelocityMethod& method, const MeshAdjacency& topology, Integrator integrator,
                 const ImplicitField& field_now, const FieldAt& field_at, double time, double step,
                 const std::vector<Vec3>& first_velocity, std::vector<Vec3>& positions) {
  std::vector<Vec3> k1 = first_velocity;
  if (k1.empty()) method.evaluate(field_now, topology, positions, k1);
  if (integrator == Integrator::euler) {
    positions = moved(positions, step, k1);
    return;
  }
  const std::shared_ptr<const ImplicitField> field_middle = field_at(time + step / 2);
  std::vector<Vec3> k2;
  method.evaluate(*field_middle, topology, moved(positions, step / 2, k1), k2);
  if (integrator == Integrator::rk2) {
    positions = moved(positions, step, k2);
    return;
  }
  std::vector<Vec3> k3, k4;
  method.evaluate(*field_middle, topology, moved(positions, step / 2, k2), k3);
  method.evaluate(*field_at(time + step), topology, moved(positions, step, k3), k4);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    positions[v] += step / 6 * (k1[v] + 2 * k2[v] + 2 * k3[v] + k4[v]);
  }
}

}  // namespace flowskin::tracking
