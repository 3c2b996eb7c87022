#include "scenes/sources/particle_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numbers>

namespace flowskin::scenes {
namespace {

using sph::Vec3;

constexpr std::size_t most_samples = 20000;
/// Where the volume of a particle says no more than this times the nearest distance, it is that of a lattice.
constexpr double lattice_tolerance = 1.03;
/// Neighbours of disordered particles are up to so many times nearer than the spacing.
constexpr double largest_disorder = 1.3;

/// Points for nanoflann.
struct PointCloud {
  const std::vector<Vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};
using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>, PointCloud, 3, int>;

/// Distances of `from` to the nearest point of the tree, the `skipped` nearest left out.
std::vector<double> distances(const std::vector<Vec3>& from, const PointTree& tree, std::size_t skipped) {
  std::vector<double> result(from.size(), std::numeric_limits<double>::infinity());
  std::vector<int> index(skipped + 1);
  std::vector<double> squared(skipped + 1);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (tree.knnSearch(from[i].data(), skipped + 1, index.data(), squared.data()) > skipped)
      result[i] = std::sqrt(squared[skipped]);
  }
  return result;
}

}  // namespace

std::vector<double> nearest_distances(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  if (to.empty()) return std::vector<double>(from.size(), std::numeric_limits<double>::infinity());
  const PointCloud cloud{to};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  return distances(from, tree, &from == &to ? 1 : 0);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double estimated_spacing(const std::vector<Vec3>& positions) {
  if (positions.size() < 2) return 0;
  const PointCloud cloud{positions};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  std::vector<Vec3> samples;
  const std::size_t stride = 1 + positions.size() / most_samples;
  for (std::size_t i = 0; i < positions.size(); i += stride) samples.push_back(positions[i]);
  const double nearest = quantile(distances(samples, tree, 1), 0.5);
  // By volume: within the distance of the 32nd neighbour there are 32.5 particles. At the surface that is too few, so
  // the denser part counts; films and drops without an inside are kept in check by the nearest neighbours.
  constexpr std::size_t neighbors = 32;
  if (positions.size() <= neighbors) return nearest;
  const double by_volume =
      quantile(distances(samples, tree, neighbors), 0.2) * std::cbrt(4 * std::numbers::pi / 3 / (neighbors + 0.5));
  if (by_volume <= lattice_tolerance * nearest) return nearest;
  return std::min(by_volume, largest_disorder * nearest);
}

}  // namespace flowskin::scenes
