// The velocity of the local rigid motion of the field [DESIGN.md: rigid].
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tracking/velocity/methods.h"
#include "tracking/velocity/motion_rows.h"
#include "tracking/velocity/pointwise_velocity.h"
#include "tracking/velocity/total_velocity.h"

namespace flowskin::tracking {
namespace {

// Chosen by measurement, see docs/velocity_methods.md.
constexpr RowWeights one_vertex_weights{3, 1, 0.3};
constexpr double least_total_weight = 1e-4;  // of the total velocity's rows where the motion is rigid
constexpr double total_weight = 3;           // more where it is not
constexpr double damping_of_total = 1;       // as in total_tangential_velocity
constexpr double spin_damping = 1e-8;        // a spin that nothing shows is zero

using Rows = MotionRows<RigidMotion>;
using RigidUnknowns = Eigen::Matrix<double, Rows::unknowns, 1>;

/// Least squares of the rows and of weight * (tangential part of v - total).
RigidUnknowns solve(const Rows& rows, const Mat32& tangents, const Vec2& total, double weight) {
  Eigen::Matrix<double, 6, 6> normal = rows.matrix.transpose() * rows.matrix;
  RigidUnknowns right = rows.matrix.transpose() * rows.right_side;
  normal.topLeftCorner<3, 3>() += weight * weight * tangents * tangents.transpose();
  normal.diagonal().tail<3>().array() += spin_damping * spin_damping;
  right.head<3>() += weight * weight * tangents * total;
  return normal.ldlt().solve(right);
}

/// What the rigid motion leaves of the change of the field's gradient and Hessian, from 0 to 1.
double unexplained(const Rows& rows, const RigidUnknowns& motion) {
  const double rest = (rows.matrix * motion - rows.right_side).squaredNorm();
  const double all =
      rows.right_side.tail<9>().squaredNorm() + (rows.matrix.bottomLeftCorner<9, 3>() * motion.head<3>()).squaredNorm();
  return all > 0 ? std::min(1.0, std::sqrt(rest / all)) : 0;
}

/// Ten equations for the six unknowns of a rigid motion, exact where the field moves rigidly and shows its spin. Where
/// it does not, the total velocity gains weight.
class RigidVelocity final : public PointwiseVelocity {
 public:
  Vec3 velocity(const SurfacePoint& point) const override {
    const Rows rows = rigid_rows(point, one_vertex_weights);
    const Vec2 total = total_tangential_velocity(point, damping_of_total);
    const RigidUnknowns first = solve(rows, point.tangents, total, least_total_weight);
    const double weight = least_total_weight + total_weight * unexplained(rows, first);
    const Vec3 v = solve(rows, point.tangents, total, weight).head<3>();
    return v + point.normal_velocity - point.normal * point.normal.dot(v);
  }
};

}  // namespace

VelocityMethodInfo rigid_velocity_info() {
  return {"rigid", "Takes the field for a rigid body around each vertex: sees rotation wherever the field shows it.",
          []() -> std::unique_ptr<VelocityMethod> { return std::make_unique<RigidVelocity>(); }};
}

}  // namespace flowskin::tracking
