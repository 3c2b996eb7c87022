// The velocity by curvature invariance [FMM13, 3.2 and 3.3]: Kanatani's and Belyaev's form of K and H.
#include "tracking/velocity/curvature_velocity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tracking/velocity/curvature.h"
#include "tracking/velocity/methods.h"
#include "tracking/velocity/pointwise_velocity.h"
#include "tracking/velocity/total_velocity.h"

namespace flowskin::tracking {
namespace {

constexpr double damping_of_total_rows = 1;  // as in total_tangential_velocity

/// The rows of K and H: how they change along the two tangents, and what is left to be made up for. K in 1/radius^2 and
/// H in 1/radius make them comparable with each other and with the rows of the total velocity.
struct CurvatureRows {
  Mat2 along_tangents;  ///< Upper row K, lower row H.
  Vec2 right_side;
};

template <class Change>
CurvatureRows curvature_rows(const SurfacePoint& point) {
  const Change change(point.jet.gradient, point.jet.hessian);
  Eigen::Matrix<double, 2, 3> along;
  for (int axis = 0; axis < 3; ++axis) {
    const Curvatures c = change(point.jet.hessian.col(axis), point.jet.third[axis]);
    along.col(axis) << c.gaussian, c.mean;
  }
  const Curvatures rate = change(point.jet.gradient_rate, point.jet.hessian_rate);
  return {along * point.tangents, -Vec2(rate.gaussian, rate.mean) - along * point.normal_velocity};
}

/// Least squares of rows a = b with the two rows weight * a = weight * total below them, by orthogonalisation.
Vec2 solve(const CurvatureRows& rows, const Vec2& total, double weight) {
  Eigen::Vector4d first, second, right;
  first << rows.along_tangents.col(0), weight, 0;
  second << rows.along_tangents.col(1), 0, weight;
  right << rows.right_side, weight * total;
  const double first2 = first.squaredNorm();
  const double shared = first.dot(second) / first2;
  second -= shared * first;
  const double of_first = first.dot(right) / first2;
  right -= of_first * first;
  const double b = second.dot(right) / second.squaredNorm();
  return {of_first - shared * b, b};
}

/// [w]x S - S [w]x, the change of a symmetric matrix that spins with w.
Mat3 spun(const Vec3& w, const Mat3& s) {
  Mat3 turned;
  for (int column = 0; column < 3; ++column) turned.col(column) = w.cross(s.col(column));
  return turned + turned.transpose();
}

/// Share of the change of gradient and Hessian at a point moving with v that no spin explains: 0 for every rigid
/// motion.
double unexplained_by_spin(const SurfacePoint& point, const Vec3& v) {
  const MotionJet& jet = point.jet;
  const Vec3 gradient_carried = jet.hessian * v;
  const Mat3 hessian_carried = point.hessian_along(v);
  const Vec3 gradient_change = jet.gradient_rate + gradient_carried;
  // The spin across the normal turns the gradient as it turns; the one about the normal turns the Hessian as best it
  // can.
  const Vec3 across = point.normal.cross(gradient_change) / point.slope;
  Mat3 rest = jet.hessian_rate + hessian_carried - spun(across, jet.hessian);
  const Mat3 about = spun(point.normal, jet.hessian);
  const double about2 = about.squaredNorm();
  if (about2 > 0) rest -= rest.cwiseProduct(about).sum() / (about2 + 1e-12 * jet.hessian.squaredNorm()) * about;
  const double stretch = point.normal.dot(gradient_change);
  const double all = jet.gradient_rate.squaredNorm() + gradient_carried.squaredNorm() + jet.hessian_rate.squaredNorm() +
                     hessian_carried.squaredNorm();
  return all > 0 ? std::min(1.0, std::sqrt((rest.squaredNorm() + stretch * stretch) / all)) : 0;
}

/// The f row [FMM13, Eq. 2] is met exactly by solving for the tangential velocity alone; the rows of K and H (Eq. 10)
/// and the total velocity's (Eq. 11) decide that one by least squares. Rows of K and H mean something only while the
/// body moves rigidly, so the total velocity gains weight as the motion departs from that.
template <class Change>
class CurvatureVelocity final : public PointwiseVelocity {
 public:
  explicit CurvatureVelocity(const CurvatureWeights& weights) : weights_(weights) {}
  Vec3 velocity(const SurfacePoint& point) const override {
    const Vec2 total = total_tangential_velocity(point, damping_of_total_rows);
    const CurvatureRows rows = curvature_rows<Change>(point);
    const Vec3 rigid = point.normal_velocity + point.tangents * solve(rows, total, weights_.least);
    const double weight = weights_.least + weights_.factor * unexplained_by_spin(point, rigid);
    return point.normal_velocity + point.tangents * solve(rows, total, weight);
  }

 private:
  CurvatureWeights weights_;
};

}  // namespace

std::unique_ptr<VelocityMethod> make_curvature_velocity(const CurvatureWeights& weights) {
  return std::make_unique<CurvatureVelocity<CurvatureChange>>(weights);
}

VelocityMethodInfo curvature_velocity_info() {
  return {
      "curvature",
      "Keeps Gaussian and mean curvature (Kanatani's form): sees rotation wherever curvature varies on the surface.",
      []() -> std::unique_ptr<VelocityMethod> { return make_curvature_velocity({}); }};
}

VelocityMethodInfo curvature_belyaev_velocity_info() {
  return {"curvature-belyaev",
          "The same with Belyaev's form of the curvatures; equal to rounding, a check on the other.",
          []() -> std::unique_ptr<VelocityMethod> {
            return std::make_unique<CurvatureVelocity<BelyaevCurvatureChange>>(CurvatureWeights{});
          }};
}

}  // namespace flowskin::tracking
