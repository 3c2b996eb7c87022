#include "tracking/velocity/coupled_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowskin::tracking {
namespace {

constexpr int kChunk = 512;           // vertices whose sums are formed together, so that they do not depend on threads
constexpr double kLongestEdge = 1e6;  // in radii
constexpr double kLeast = 1e-12;      // eigenvalues smaller than this share of the largest count as zero
constexpr double kRidge = 1e-13;      // keeps the block of a lone vertex invertible, relative to its trace

int chunk_count(std::size_t vertices) { return static_cast<int>((vertices + kChunk - 1) / kChunk); }

// Number of the component of each vertex, components in the order of their lowest vertex.
std::vector<int> components(const MeshAdjacency& topology, int count) {
  std::vector<int> of_vertex(count, -1), open;
  int next = 0;
  for (int seed = 0; seed < count; ++seed) {
    if (of_vertex[seed] >= 0) continue;
    of_vertex[seed] = next;
    if (topology.vertex_count() == count) open.push_back(seed);
    while (!open.empty()) {
      const int vertex = open.back();
      open.pop_back();
      for (const auto& neighbor : topology.ring(vertex)) {
        if (of_vertex[neighbor.vertex] >= 0) continue;
        of_vertex[neighbor.vertex] = next;
        open.push_back(neighbor.vertex);
      }
    }
    ++next;
  }
  return of_vertex;
}

// Of the motions that fit the field equally well (a ball may spin, a pair of particles may shear as well as turn) the
// one with the least strain, and of those the one with the least gradient. Of any size: a few calls a step are not
// worth code for each.
Eigen::VectorXd plainest_solution(const Eigen::MatrixXd& block, const Eigen::VectorXd& right_side,
                                  const Eigen::MatrixXd& plainness) {
  const Eigen::Index n = block.rows(), parameters = plainness.cols();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(block);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * right_side;
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(n);
  Eigen::Index free = 0;  // eigenvectors that the field does not see; eigenvalues ascend
  for (Eigen::Index k = 0; k < n; ++k) {
    if (values[k] > kLeast * values[n - 1]) {
      solution += along[k] / values[k] * solver.eigenvectors().col(k);
    } else {
      ++free;
    }
  }
  if (free == 0) return solution;
  const Eigen::MatrixXd choices = plainness * solver.eigenvectors().leftCols(free).bottomRows(parameters);
  const Eigen::VectorXd excess = plainness * solution.tail(parameters);
  const Eigen::VectorXd change = choices.completeOrthogonalDecomposition().solve(-excess);
  return solution + solver.eigenvectors().leftCols(free) * change;
}

template <class Motion>
class CoupledSystem {
 public:
  static constexpr int n = 3 + Motion::parameters;
  using Vector = Eigen::Matrix<double, n, 1>;
  using Matrix = Eigen::Matrix<double, n, n>;
  using Gradient = typename Motion::Gradient;
  using Field = std::vector<Vector>;  // one motion per vertex: velocity (radii/s) and gradient parameters (1/s)

  CoupledSystem(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<Vec3>& positions,
                const CouplingWeights& weights)
      : count_(static_cast<int>(positions.size())),
        topology_(topology.vertex_count() == count_ ? &topology : nullptr),
        weights_(weights),
        places_(count_),
        seen_(count_, 0),
        blocks_(count_),
        right_side_(count_) {
    add_field_rows(field, positions);
    start_ = best_common_motions(components(topology, count_));
    add_edges_to_blocks();
  }

  CouplingReport solve(const SolverLimits& limits) {
    CouplingReport report;
    Field residual = right_side_;
    subtract_product(start_, residual);
    factorize_blocks();
    const Field scaled_right_side = scaled(right_side_);
    const double all = dot(scaled_right_side, scaled_right_side);
    residual = scaled(residual);
    double rest = dot(residual, residual);
    // The unknown is the change of the start, in the scaled basis L^T y.
    Field change(count_, Vector::Zero()), direction = residual, product(count_);
    const double enough = limits.tolerance * limits.tolerance * all;
    while (rest > enough && report.iterations < limits.max_iterations) {
      multiply_scaled(direction, product);
      const double curvature = dot(direction, product);
      if (!(curvature > 0)) break;
      const double step = rest / curvature;
      double next = step_along(step, direction, product, change, residual);
      turn_direction(next / rest, residual, direction);
      rest = next;
      ++report.iterations;
    }
    report.residual = all > 0 ? std::sqrt(rest / all) : 0;
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) start_[v] += unscale(v, change[v]);
    return report;
  }

  // In radii/s.
  Vec3 velocity(int vertex) const { return start_[vertex].template head<3>(); }

 private:
  void add_field_rows(const ImplicitField& field, const std::vector<Vec3>& positions) {
    const FieldScale scale = field.scale();
    Neighborhoods(field, positions).for_each([&](int v, const LocalField& local) {
      places_[v] = positions[v] / scale.length;
      blocks_[v].setZero();
      right_side_[v].setZero();
      const SurfacePoint point(local.motion_jet(positions[v]), scale);
      if (!point.defined) return;
      const MotionRows<Motion> rows = field_rows(local, positions[v], point, weights_.rows, Motion());
      const Matrix block = rows.matrix.transpose() * rows.matrix;
      const Vector right = rows.matrix.transpose() * rows.right_side;
      if (!block.allFinite() || !right.allFinite()) return;
      blocks_[v] = block;
      right_side_[v] = right;
      seen_[v] = 1;
    });
  }

  // Columns: the velocities at distance d that the gradient parameters give.
  static Eigen::Matrix<double, 3, Motion::parameters> lever(const Vec3& d) {
    Eigen::Matrix<double, 3, Motion::parameters> x;
    for (int k = 0; k < Motion::parameters; ++k) x.col(k) = Motion::apply(Gradient::Unit(k), d);
    return x;
  }

  // The one motion of each component that its field rows like best; edges are content with any. Of several, the least.
  Field best_common_motions(const std::vector<int>& component) const {
    struct Sum {
      int component;
      Matrix block = Matrix::Zero();
      Vector right_side = Vector::Zero();
    };
    const int part_count = count_ == 0 ? 0 : 1 + *std::max_element(component.begin(), component.end());
    std::vector<Vec3> centers(part_count, Vec3::Zero());
    std::vector<int> sizes(part_count, 0);
    for (int v = 0; v < count_; ++v) {
      if (!seen_[v]) continue;
      centers[component[v]] += places_[v];
      ++sizes[component[v]];
    }
    for (int c = 0; c < part_count; ++c) centers[c] /= std::max(1, sizes[c]);

    std::vector<std::vector<Sum>> sums(chunk_count(count_));
#pragma omp parallel for schedule(static)
    for (int chunk = 0; chunk < static_cast<int>(sums.size()); ++chunk) {
      for (int v = chunk * kChunk; v < std::min(count_, (chunk + 1) * kChunk); ++v) {
        if (!seen_[v]) continue;
        if (sums[chunk].empty() || sums[chunk].back().component != component[v]) sums[chunk].push_back({component[v]});
        Matrix to_vertex = Matrix::Identity();
        to_vertex.template topRightCorner<3, Motion::parameters>() = lever(places_[v] - centers[component[v]]);
        sums[chunk].back().block += to_vertex.transpose() * (blocks_[v] * to_vertex);
        sums[chunk].back().right_side += to_vertex.transpose() * right_side_[v];
      }
    }
    std::vector<Sum> parts(part_count);
    for (const auto& chunk : sums) {
      for (const Sum& sum : chunk) {
        parts[sum.component].block += sum.block;
        parts[sum.component].right_side += sum.right_side;
      }
    }
    std::vector<Vector> motions(part_count);
    for (int c = 0; c < part_count; ++c) {
      motions[c] = plainest_solution(parts[c].block, parts[c].right_side, Motion::plainness());
    }
    Field start(count_);
    for (int v = 0; v < count_; ++v) {
      const Vector& motion = motions[component[v]];
      const Gradient gradient = motion.template tail<Motion::parameters>();
      start[v] = motion;
      start[v].template head<3>() += Motion::apply(gradient, places_[v] - centers[component[v]]);
      if (!start[v].allFinite()) start[v].setZero();
    }
    return start;
  }

  // Zero for ends in one place, and where one of them is nowhere near.
  double edge_weight(const Vec3& d) const {
    const double length2 = d.squaredNorm();
    return length2 > 0 && length2 < kLongestEdge * kLongestEdge ? weights_.velocity / length2 : 0;
  }

  void add_edges_to_blocks() {
    if (topology_ == nullptr) return;
#pragma omp parallel for schedule(dynamic, 64)
    for (int v = 0; v < count_; ++v) {
      Matrix& block = blocks_[v];
      for (const auto& neighbor : topology_->ring(v)) {
        const Vec3 d = places_[v] - places_[neighbor.vertex];
        const double w = edge_weight(d);
        if (w == 0) continue;
        const auto x = lever(d);
        block.template topLeftCorner<3, 3>().diagonal().array() += w;
        block.template topRightCorner<3, Motion::parameters>() -= 0.5 * w * x;
        block.template bottomLeftCorner<Motion::parameters, 3>() -= 0.5 * w * x.transpose();
        block.template bottomRightCorner<Motion::parameters, Motion::parameters>() += 0.25 * w * x.transpose() * x;
        block.template bottomRightCorner<Motion::parameters, Motion::parameters>().diagonal().array() +=
            weights_.gradient;
      }
    }
  }

  // The product of the matrix without its diagonal blocks.
  Vector coupling(int vertex, const Field& y) const {
    Vec3 force = Vec3::Zero();
    Gradient moment = Gradient::Zero();
    for (const auto& neighbor : topology_->ring(vertex)) {
      const Vec3 d = places_[vertex] - places_[neighbor.vertex];
      const double w = edge_weight(d);
      if (w == 0) continue;
      const Vector& other = y[neighbor.vertex];
      const Gradient gradient = other.template tail<Motion::parameters>();
      const Vec3 carried = w * (other.template head<3>() + 0.5 * Motion::apply(gradient, d));
      force -= carried;
      moment += 0.5 * Motion::adjoint(carried, d) - weights_.gradient * gradient;
    }
    Vector result;
    result.template head<3>() = force;
    result.template tail<Motion::parameters>() = moment;
    return result;
  }

  void subtract_product(const Field& y, Field& from) const {
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) {
      from[v] -= blocks_[v] * y[v];
      if (topology_ != nullptr) from[v] -= coupling(v, y);
    }
  }

  // Replaces each block by the inverse of its Cholesky factor.
  void factorize_blocks() {
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) {
      Matrix& block = blocks_[v];
      block.diagonal().array() += kRidge * block.trace();
      const Eigen::LLT<Matrix> factor(block);
      Matrix inverse = Matrix::Zero();
      if (factor.info() == Eigen::Success) {
        inverse.setIdentity();
        factor.matrixL().solveInPlace(inverse);
      }
      block = inverse.allFinite() ? inverse : Matrix(Matrix::Zero());
    }
  }

  Vector scale(int v, const Vector& y) const { return blocks_[v].template triangularView<Eigen::Lower>() * y; }
  Vector unscale(int v, const Vector& y) const {
    return blocks_[v].transpose().template triangularView<Eigen::Upper>() * y;
  }

  Field scaled(const Field& y) const {
    Field result(count_);
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) result[v] = scale(v, y[v]);
    return result;
  }

  void multiply_scaled(const Field& y, Field& product) {
    unscaled_.resize(count_);
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) unscaled_[v] = unscale(v, y[v]);
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) {
      product[v] = y[v];
      if (topology_ != nullptr) product[v] += scale(v, coupling(v, unscaled_));
    }
  }

  double dot(const Field& a, const Field& b) const {
    return sum_of_chunks([&](int v) { return a[v].dot(b[v]); });
  }

  // Moves on and returns the square of the residual that is left.
  double step_along(double step, const Field& direction, const Field& product, Field& change, Field& residual) const {
    return sum_of_chunks([&](int v) {
      change[v] += step * direction[v];
      residual[v] -= step * product[v];
      return residual[v].squaredNorm();
    });
  }

  void turn_direction(double share, const Field& residual, Field& direction) const {
#pragma omp parallel for schedule(static, kChunk)
    for (int v = 0; v < count_; ++v) direction[v] = residual[v] + share * direction[v];
  }

  template <class Term>
  double sum_of_chunks(const Term& term) const {
    std::vector<double> sums(chunk_count(count_), 0.0);
#pragma omp parallel for schedule(static)
    for (int chunk = 0; chunk < static_cast<int>(sums.size()); ++chunk) {
      for (int v = chunk * kChunk; v < std::min(count_, (chunk + 1) * kChunk); ++v) sums[chunk] += term(v);
    }
    double all = 0;
    for (const double sum : sums) all += sum;
    return all;
  }

  int count_;
  const MeshAdjacency* topology_;  // null: no edges
  CouplingWeights weights_;
  std::vector<Vec3> places_;    // in radii
  std::vector<char> seen_;      // the field says something there
  std::vector<Matrix> blocks_;  // of the diagonal; later the inverses of their Cholesky factors
  Field right_side_, start_, unscaled_;
};

}  // namespace

template <class Motion>
CouplingReport coupled_velocities(const ImplicitField& field, const MeshAdjacency& topology,
                                  const std::vector<Vec3>& positions, const CouplingWeights& weights,
                                  const SolverLimits& limits, std::vector<Vec3>& velocities) {
  CoupledSystem<Motion> system(field, topology, positions, weights);
  const CouplingReport report = system.solve(limits);
  const double radius = field.scale().length;
  velocities.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 velocity = radius * system.velocity(static_cast<int>(v));
    velocities[v] = velocity.allFinite() ? velocity : Vec3(Vec3::Zero());
  }
  return report;
}

template CouplingReport coupled_velocities<RigidMotion>(const ImplicitField&, const MeshAdjacency&,
                                                        const std::vector<Vec3>&, const CouplingWeights&,
                                                        const SolverLimits&, std::vector<Vec3>&);
template CouplingReport coupled_velocities<AffineMotion>(const ImplicitField&, const MeshAdjacency&,
                                                         const std::vector<Vec3>&, const CouplingWeights&,
                                                         const SolverLimits&, std::vector<Vec3>&);

}  // namespace flowskin::tracking
