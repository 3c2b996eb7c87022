// How far a carried mesh is from where its material is. Lengths as given; docs/paper.md says what each measure sees.
#pragma once

#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// Distances between two sets of points, vertex by vertex; all zero where there are none.
struct Distances {
  double mean = 0, max = 0;
};

/// @throws std::invalid_argument where the sets differ in size.
Distances distances(const std::vector<Vec3>& points, const std::vector<Vec3>& truth);

/// RMS |v - v_true| / RMS |v_true|: 0 is exact, 1 as wrong as no velocity at all. Where the true velocity is zero
/// everywhere: 0 where v is zero as well, else infinity.
/// @throws std::invalid_argument where the sets differ in size.
double relative_velocity_error(const std::vector<Vec3>& velocities, const std::vector<Vec3>& truth);

/// RMS over the edges of |length / rest length - 1|: 0 for a mesh that kept its shape.
/// @throws std::invalid_argument where the sets differ in size or a rest length is not positive.
double edge_strain(const std::vector<double>& lengths, const std::vector<double>& rest_lengths);

/// The mean of what is added.
class Average {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// Exponent p of error = c steps^-p, by least squares on logarithms over the points whose error exceeds `floor`, below
/// which rounding or projection show rather than the time step. NaN where fewer than two such points are left.
double convergence_order(const std::vector<int>& steps, const std::vector<double>& errors, double floor);

}  // namespace flowskin::tools
