// The particles' own velocity by moving least squares; the surface is met by the field's normal velocity.
#include "tracking/field/neighborhoods.h"
#include "tracking/velocity/methods.h"
#include "tracking/velocity/moving_least_squares.h"
#include "tracking/velocity/particle_velocities.h"
#include "tracking/velocity/surface_point.h"

namespace flowskin::tracking {
namespace {

class SimulationVelocity final : public VelocityMethod {
 public:
  void evaluate(const ImplicitField& field, const MeshAdjacency& /*topology*/, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const override {
    require_particle_velocities(field, "simulation");
    velocities.resize(positions.size());
    Neighborhoods(field, positions).for_each([&](int i, const LocalField& local) {
      const SurfacePoint point(local.motion_jet(positions[i]), field.scale());
      const Vec3 v = local_flow(*local.particles(), positions[i]).velocity;
      velocities[i] = point.defined ? meeting_surface(point, v, field.scale().length) : Vec3(Vec3::Zero());
    });
  }

 private:
  static Vec3 meeting_surface(const SurfacePoint& point, const Vec3& v, double radius) {
    const Vec3 result = v + radius * point.normal_velocity - point.normal * point.normal.dot(v);
    return result.allFinite() ? result : Vec3(Vec3::Zero());
  }
};

}  // namespace

VelocityMethodInfo simulation_velocity_info() {
  return {"simulation", "The particles' own velocity, by moving least squares: exact for every linear flow.",
          []() -> std::unique_ptr<VelocityMethod> { return std::make_unique<SimulationVelocity>(); }, true};
}

}  // namespace flowskin::tracking
