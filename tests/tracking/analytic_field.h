// A field that is not made of particles: a sum of Gaussians, each carried along by a flow of its own, with all
// derivatives in closed form.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tracking/extraction/sparse_grid.h"
#include "tracking/field/field_motion.h"

namespace flowskin::tracking::test {

/// a exp(-(x - c)^T S (x - c)), carried along by the flow u(x) = velocity + gradient (x - c).
struct Blob {
  Vec3 center = Vec3::Zero();
  Mat3 shape = Mat3::Identity();  ///< S; symmetric and positive
  double amplitude = 1;
  Vec3 velocity = Vec3::Zero();
  Mat3 gradient = Mat3::Zero();
};

inline Blob round_blob(const Vec3& center, double width, double amplitude) {
  return {center, Mat3(Mat3::Identity() / (width * width)), amplitude};
}

/// The sum of the blobs less a threshold.
class AnalyticField final : public ImplicitField {
 public:
  AnalyticField(std::vector<Blob> blobs, double threshold, FieldScale scale)
      : blobs_(std::move(blobs)), threshold_(threshold), scale_(scale) {}

  double value(const Vec3& x) const override {
    Vec3 gradient;
    return value(x, gradient);
  }
  double value(const Vec3& x, Vec3& gradient) const override {
    gradient.setZero();
    double sum = -threshold_;
    for (const Blob& blob : blobs_) {
      const Vec3 q = 2 * blob.shape * (x - blob.center);
      const double f = height(blob, x);
      sum += f;
      gradient -= f * q;
    }
    return sum;
  }
  MotionJet motion_jet(const Vec3& x) const override {
    MotionJet sum;
    sum.moving_value = -threshold_;
    for (const Blob& blob : blobs_) add(blob, x, sum);
    return sum;
  }
  FieldScale scale() const override { return scale_; }
  std::shared_ptr<const SparseGrid> on_grid(double spacing) const override {
    Box box{Vec3::Constant(1e9), Vec3::Constant(-1e9)};
    for (const Blob& blob : blobs_) {
      // Beyond this distance no blob reaches its share of the threshold.
      const double least = Eigen::SelfAdjointEigenSolver<Mat3>(blob.shape).eigenvalues()[0];
      const double share = threshold_ / (static_cast<double>(blobs_.size()) * blob.amplitude);
      const Vec3 reach = Vec3::Constant(std::sqrt(std::max(0.0, -std::log(share)) / least));
      box.min = box.min.cwiseMin(blob.center - reach);
      box.max = box.max.cwiseMax(blob.center + reach);
    }
    if (blobs_.empty()) box = {};
    return std::make_shared<const SparseGrid>(
        SparseGrid::of_function([this](const Vec3& x) { return value(x); }, box, -threshold_, spacing));
  }

 private:
  static double height(const Blob& blob, const Vec3& x) {
    const Vec3 d = x - blob.center;
    return blob.amplitude * std::exp(-d.dot(blob.shape * d));
  }

  static void add(const Blob& blob, const Vec3& x, MotionJet& sum) {
    const double f = height(blob, x);
    const Vec3 q = 2 * blob.shape * (x - blob.center);
    const Mat3 qq = 2 * blob.shape;
    const Vec3 first = -f * q;
    const Mat3 second = f * (q * q.transpose() - qq);
    const Vec3 u = blob.velocity + blob.gradient * (x - blob.center);
    const Mat3& a = blob.gradient;  // du_k / dx_i = a(k, i)
    Mat3 carried = Mat3::Zero();    // f_ijk u_k
    for (int k = 0; k < 3; ++k) {
      Mat3 third = -f * q[k] * (q * q.transpose() - qq);
      third += f * (q * qq.row(k) + (q * qq.row(k)).transpose());
      sum.third[k] += third;
      carried += u[k] * third;
    }
    sum.moving_value += f;
    sum.gradient += first;
    sum.hessian += second;
    sum.value_rate -= first.dot(u);
    sum.gradient_rate -= second * u + a.transpose() * first;
    sum.hessian_rate -= carried + second * a + (second * a).transpose();
  }

  std::vector<Blob> blobs_;
  double threshold_;
  FieldScale scale_;
};

/// Blobs that move rigidly, each on its own: about `pivot` with `spin` (rad/s), and with `velocity` (m/s).
struct RigidPath {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero(), pivot = Vec3::Zero();

  Mat3 rotation(double time) const {
    const double speed = spin.norm();
    return speed > 0 ? Eigen::AngleAxisd(speed * time, spin / speed).toRotationMatrix() : Mat3(Mat3::Identity());
  }
  Vec3 place(const Vec3& start, double time) const {
    return pivot + time * velocity + rotation(time) * (start - pivot);
  }
  Vec3 velocity_at(const Vec3& x, double time) const { return velocity + spin.cross(x - pivot - time * velocity); }
};

/// Blobs and their paths from one time to another.
struct AnalyticScene {
  std::vector<Blob> blobs;  ///< At time 0.
  std::vector<RigidPath> paths;
  double threshold = 0.35;
  FieldScale scale{0.5, 0.5};

  std::shared_ptr<const AnalyticField> field(double time) const {
    std::vector<Blob> moved = blobs;
    for (std::size_t i = 0; i < blobs.size(); ++i) {
      const RigidPath& path = paths[std::min(i, paths.size() - 1)];
      const Mat3 turned = path.rotation(time);
      moved[i].center = path.place(blobs[i].center, time);
      moved[i].shape = turned * blobs[i].shape * turned.transpose();
      moved[i].velocity = path.velocity_at(moved[i].center, time);
      for (int k = 0; k < 3; ++k) moved[i].gradient.col(k) = path.spin.cross(Vec3::Unit(k));
    }
    return std::make_shared<const AnalyticField>(std::move(moved), threshold, scale);
  }
};

class AnalyticMotion final : public FieldMotion {
 public:
  AnalyticMotion(const AnalyticScene& scene, double begin, double end) : scene_(scene), begin_(begin), end_(end) {}
  double begin_time() const override { return begin_; }
  double end_time() const override { return end_; }
  std::shared_ptr<const ImplicitField> field(double time) const override { return scene_.field(time); }
  double longest_path() const override {
    double fastest = 0;
    for (const RigidPath& path : scene_.paths) fastest = std::max(fastest, path.velocity.norm() + 2 * path.spin.norm());
    return (end_ - begin_) * fastest;
  }

 private:
  const AnalyticScene& scene_;
  double begin_, end_;
};

}  // namespace flowskin::tracking::test
