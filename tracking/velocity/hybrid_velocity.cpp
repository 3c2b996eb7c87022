// The particles' own flow, corrected by the field's equations where the particles contradict each other.
#include <Eigen/Cholesky>

#include "tracking/field/neighborhoods.h"
#include "tracking/velocity/methods.h"
#include "tracking/velocity/motion_rows.h"
#include "tracking/velocity/moving_least_squares.h"
#include "tracking/velocity/particle_velocities.h"

namespace flowskin::tracking {
namespace {

// Chosen by measurement, see docs/velocity_methods.md.
constexpr RowWeights hybrid_weights{1, 1, 1};
constexpr double flow_weight = 100;       // of the particles' flow, for a misfit of 1; it grows as 1 / misfit^2
constexpr double least_misfit = 3e-5;     // squares of smaller misfits are rounding
constexpr int flow_unknowns = 4;          // particles that a linear flow always fits
constexpr double strain_share = 2.0 / 3;  // of the errors of a gradient's nine elements

using AffineUnknowns = Eigen::Matrix<double, 12, 1>;

AffineUnknowns motion_of(const LocalFlow& flow, double radius) {
  AffineUnknowns motion;
  motion << flow.velocity / radius, flow.gradient.reshaped();
  return motion;
}

/// As few particles are always met by a linear flow, their misfit is taken for what more of them would show.
double expected_misfit2(const LocalFlow& flow) {
  if (flow.neighbors <= flow_unknowns) return 1;
  const double n = flow.neighbors;
  return flow.misfit * flow.misfit * n / (n - flow_unknowns) + least_misfit * least_misfit;
}

/// The strain rate is the part of the flow that noise fakes most easily, and it is extrapolated to the surface: what is
/// not larger than its expected error is taken out [positive-part James-Stein].
LocalFlow with_significant_strain(LocalFlow flow) {
  const Mat3 strain = (flow.gradient + flow.gradient.transpose()) / 2;
  const double error2 = strain_share * flow.gradient_error2, strain2 = strain.squaredNorm();
  const Mat3 removed = strain2 > error2 ? Mat3(error2 / strain2 * strain) : strain;
  flow.gradient -= removed;
  flow.velocity += removed * flow.center;
  return flow;
}

/// Least squares of the field's ten rows and of the distance to the particles' flow.
Vec3 hybrid_velocity(const LocalField& field, const Vec3& x) {
  const LocalParticles& particles = *field.particles();
  const double radius = particles.all().radius();
  const LocalFlow flow = with_significant_strain(local_flow(particles, x));
  const SurfacePoint point(field.motion_jet(x), field.scale());
  if (!point.defined || !flow.defined) return flow.velocity;
  const auto rows = affine_rows(point, particles.moments(x), hybrid_weights);
  const double weight = flow_weight / expected_misfit2(flow);
  // In the change of the particles' flow: exact where the field agrees with it.
  const AffineUnknowns start = motion_of(flow, radius);
  Eigen::Matrix<double, 12, 12> normal = rows.matrix.transpose() * rows.matrix;
  normal.diagonal().array() += weight;
  const AffineUnknowns right = rows.matrix.transpose() * (rows.right_side - rows.matrix * start);
  const Vec3 change = radius * normal.llt().solve(right).head<3>();
  return change.allFinite() ? Vec3(flow.velocity + change) : flow.velocity;
}

class HybridVelocity final : public VelocityMethod {
 public:
  void evaluate(const ImplicitField& field, const MeshAdjacency& /*topology*/, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const override {
    require_particle_velocities(field, "hybrid");
    velocities.resize(positions.size());
    Neighborhoods(field, positions).for_each([&](int i, const LocalField& local) {
      velocities[i] = hybrid_velocity(local, positions[i]);
    });
  }
};

}  // namespace

VelocityMethodInfo hybrid_velocity_info() {
  return {"hybrid",
          "The particles' own velocity, corrected by the field where the particles contradict each other: the best in "
          "a simulation.",
          []() -> std::unique_ptr<VelocityMethod> { return std::make_unique<HybridVelocity>(); }, true};
}

}  // namespace flowskin::tracking
