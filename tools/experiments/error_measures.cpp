#include "tools/experiments/error_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace flowskin::tools {
namespace {

void check_sizes(const char* measure, std::size_t measured, std::size_t truth) {
  if (measured != truth)
    throw std::invalid_argument(fmt::format("{}: {} values against {} true ones", measure, measured, truth));
}

}  // namespace

Distances distances(const std::vector<Vec3>& points, const std::vector<Vec3>& truth) {
  check_sizes("distances", points.size(), truth.size());
  Distances result;
  if (points.empty()) return result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i] - truth[i]).norm();
    result.mean += distance;
    result.max = std::max(result.max, distance);
  }
  result.mean /= double(points.size());
  return result;
}

double relative_velocity_error(const std::vector<Vec3>& velocities, const std::vector<Vec3>& truth) {
  check_sizes("relative velocity error", velocities.size(), truth.size());
  double wrong = 0, right = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    wrong += (velocities[i] - truth[i]).squaredNorm();
    right += truth[i].squaredNorm();
  }
  if (wrong == 0) return 0;
  return right > 0 ? std::sqrt(wrong / right) : std::numeric_limits<double>::infinity();
}

double edge_strain(const std::vector<double>& lengths, const std::vector<double>& rest_lengths) {
  check_sizes("edge strain", lengths.size(), rest_lengths.size());
  if (lengths.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (!(rest_lengths[i] > 0)) throw std::invalid_argument("edge strain: a rest length is not positive");
    const double strain = lengths[i] / rest_lengths[i] - 1;
    sum += strain * strain;
  }
  return std::sqrt(sum / double(lengths.size()));
}

double convergence_order(const std::vector<int>& steps, const std::vector<double>& errors, double floor) {
  check_sizes("convergence order", steps.size(), errors.size());
  double count = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(errors[i] > floor)) continue;
    const double x = std::log(double(steps[i])), y = std::log(errors[i]);
    count += 1, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  const double spread = count * sum_xx - sum_x * sum_x;
  if (count < 2 || !(spread > 0)) return std::numeric_limits<double>::quiet_NaN();
  return -(count * sum_xy - sum_x * sum_y) / spread;
}

}  // namespace flowskin::tools
