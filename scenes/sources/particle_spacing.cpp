#include "scenes/sources/particle_spacing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numbers>
#include <tuple>

#include "common/outliers.h"

namespace flowskin::scenes {
namespace {

using sph::Vec3;

constexpr std::size_t most_samples = 20000;
/// Particles nearer to each other than this share of the distance of their eighth neighbours are in one place.
constexpr double same_place = 0.01;
/// Extents smaller than this share of the largest are none.
constexpr double flatness = 1e-4;
/// Neighbours that may span a cell.
constexpr std::size_t cell_neighbors = 20;
/// Least sine of the angle between the edges of a cell, and between an edge and the face of the others.
constexpr double least_sine = 0.35, least_elevation = 0.3;
/// Cells whose edges differ less than this, half of them, are those of a lattice.
constexpr double lattice_spread = 0.012;
/// Neighbours in a ball inside the fluid, about.
constexpr std::size_t ball_neighbors = 32;
/// Balls with their centre of mass nearer to the middle (in radii) and a less flat content are inside.
constexpr double most_offset = 0.17, least_roundness = 0.65;
/// So many balls, and such a share of all, are enough to count on.
constexpr std::size_t least_inside = 12;
constexpr double least_share_inside = 0.01;

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

std::vector<Vec3> samples_of(const std::vector<Vec3>& points) {
  std::vector<Vec3> samples;
  const std::size_t stride = 1 + points.size() / most_samples;
  for (std::size_t i = 0; i < points.size(); i += stride) samples.push_back(points[i]);
  return samples;
}

/// Each place once: particles in the very same place, and those whose places differ by rounding only.
std::vector<Vec3> distinct_places(std::vector<Vec3> points) {
  const auto key = [](const Vec3& x) { return std::make_tuple(x.x(), x.y(), x.z()); };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() <= 9) return points;
  const PointCloud cloud{points};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  const double near = same_place * quantile(distances(samples_of(points), tree, 8), 0.5);
  std::vector<Vec3> distinct;
  std::vector<std::pair<int, double>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.radiusSearch(points[i].data(), near * near, found, unsorted);
    const bool is_first = std::all_of(found.begin(), found.end(),
                                      [&](const auto& other) { return static_cast<std::size_t>(other.first) >= i; });
    if (is_first) distinct.push_back(points[i]);
  }
  return distinct;
}

int dimensions_of(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : points) mean += x / static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Vec3& x : points) moments += (x - mean) * (x - mean).transpose();
  const Vec3 extents = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvalues().cwiseMax(0).cwiseSqrt();
  return 1 + (extents[1] > flatness * extents[2]) + (extents[0] > flatness * extents[2]);
}

/// Edge of the cube with the volume of the cell that the nearest neighbours of x span (in a plane: of the square with
/// its area); 0 where there are too few.
double cell_edge(const Vec3& x, const PointTree& tree, const std::vector<Vec3>& points, int dimensions) {
  std::array<int, cell_neighbors + 1> index;
  std::array<double, cell_neighbors + 1> squared;
  const std::size_t found = tree.knnSearch(x.data(), cell_neighbors + 1, index.data(), squared.data());
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
  for (std::size_t k = 1; k < found; ++k) {
    const Vec3 edge = points[static_cast<std::size_t>(index[k])] - x;
    const double length = edge.norm();
    if (length == 0) continue;
    if (dimensions == 1) return length;
    if (first.isZero()) {
      first = edge;
    } else if (second.isZero()) {
      const double area = first.cross(edge).norm();
      if (area < least_sine * first.norm() * length) continue;
      if (dimensions == 2) return std::sqrt(area);
      second = edge;
    } else {
      const Vec3 face = first.cross(second);
      const double volume = std::abs(face.dot(edge));
      if (volume >= least_elevation * face.norm() * length) return std::cbrt(volume);
    }
  }
  return 0;
}

std::vector<double> cell_edges(const std::vector<Vec3>& samples, const PointTree& tree, const std::vector<Vec3>& points,
                               int dimensions) {
  std::vector<double> edges;
  for (const Vec3& x : samples)
    if (const double edge = cell_edge(x, tree, points, dimensions); edge > 0) edges.push_back(edge);
  return edges;
}

/// Spacing of a single layer, even if not quite flat: 0 where there are more. In disorder nearest neighbours, from
/// which cells are made, are nearer than the rest, so the area of the layer around each particle counts.
double film_spacing(const std::vector<Vec3>& points, const std::vector<Vec3>& samples, const PointTree& tree) {
  constexpr std::size_t neighbors = 20;
  constexpr double thinnest = 0.45;  // of the spacing in the layer, as standard deviation across it
  if (points.size() <= neighbors) return 0;
  std::array<int, neighbors + 1> index;
  std::array<double, neighbors + 1> squared;
  std::vector<double> spacings, deviations;
  for (const Vec3& x : samples) {
    const std::size_t found = tree.knnSearch(x.data(), neighbors + 1, index.data(), squared.data());
    if (found <= neighbors) return 0;
    Vec3 mean = Vec3::Zero();
    for (const int k : index) mean += points[static_cast<std::size_t>(k)] / double(neighbors + 1);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const int k : index) {
      const Vec3 offset = points[static_cast<std::size_t>(k)] - mean;
      moments += offset * offset.transpose() / double(neighbors + 1);
    }
    const Vec3 axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues();
    deviations.push_back(std::sqrt(std::max(0.0, axes[0])));
    spacings.push_back(std::sqrt(std::numbers::pi * squared[neighbors] / (neighbors + 0.5)));
  }
  const double spacing = quantile(spacings, 0.25);  // less than at the rim
  return quantile(deviations, 0.5) < thinnest * spacing ? spacing : 0;
}

/// Particles per volume around x by those within the radius; 0 where x is not inside the fluid.
double density_inside(const Vec3& x, double radius, const PointTree& tree, const std::vector<Vec3>& points) {
  constexpr double rim = 0.7;  // counted less from here on, since shells of neighbours come at certain distances
  static const double volume =
      4 * std::numbers::pi *
      (rim * rim * rim / 3 + ((1 - std::pow(rim, 3)) / 3 - (1 - std::pow(rim, 4)) / 4) / (1 - rim));
  std::vector<std::pair<int, double>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  tree.radiusSearch(x.data(), radius * radius, found, unsorted);
  double sum = -0.5;  // of x itself, half: all in a lattice, none in disorder
  Vec3 offset = Vec3::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const auto& [k, squared] : found) {
    const Vec3 place = (points[static_cast<std::size_t>(k)] - x) / radius;
    const double weight = std::min(1.0, (1 - place.norm()) / (1 - rim));
    sum += weight;
    offset += weight * place;
    moments += weight * place * place.transpose();
  }
  if (!(sum > 4) || offset.norm() > most_offset * sum) return 0;
  const Vec3 axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues();
  if (axes[0] < least_roundness * axes.sum() / 3) return 0;
  return sum / (volume * std::pow(radius, 3));
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

SpacingEstimate estimate_spacing(const std::vector<Vec3>& positions) {
  SpacingEstimate estimate;
  const std::vector<Vec3> points = distinct_places(positions);
  estimate.coincident = positions.size() - points.size();
  if (points.size() < 2) return estimate;
  const PointCloud cloud{points};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  const std::vector<Vec3> samples = samples_of(points);
  estimate.dimensions = dimensions_of(without_outliers(points, 0));
  const std::vector<double> edges = cell_edges(samples, tree, points, estimate.dimensions);
  const double edge = quantile(edges, 0.5);
  if (edges.size() < 4) {
    estimate.spacing = quantile(distances(samples, tree, 1), 0.5);
    estimate.uncertainty = 0.5;
    estimate.method = "by the distances of the few particles";
    return estimate;
  }
  const double spread = (quantile(edges, 0.75) - quantile(edges, 0.25)) / edge;
  estimate.spacing = edge;
  estimate.uncertainty = 0.01;
  estimate.method = "the particles lie in a lattice";
  if (spread < lattice_spread) return estimate;
  if (const double film = film_spacing(points, samples, tree); estimate.dimensions == 3 && film > 0) {
    estimate.spacing = film;
    estimate.uncertainty = 0.1;
    estimate.method = "the particles lie in one layer";
    return estimate;
  }
  const double radius = quantile(distances(samples, tree, ball_neighbors), 0.3);
  std::vector<double> densities;
  if (std::isfinite(radius))
    for (const Vec3& x : samples)
      if (const double density = density_inside(x, radius, tree, points); density > 0) densities.push_back(density);
  if (densities.size() >= least_inside &&
      static_cast<double>(densities.size()) >= least_share_inside * static_cast<double>(samples.size())) {
    estimate.spacing = std::cbrt(1 / quantile(densities, 0.5));
    estimate.uncertainty = 0.05;
    estimate.method = "by counting particles inside the fluid";
    return estimate;
  }
  // Cells of particles in disorder are of those neighbours that happen to be near (measured on jittered lattices).
  constexpr double shortfall = 0.1;
  estimate.spacing = edge * (1 + shortfall * std::min(1.0, spread / 0.3));
  estimate.uncertainty = 0.15;
  estimate.method = "by the nearest neighbours: there is no inside to count in";
  return estimate;
}

double estimated_spacing(const std::vector<Vec3>& positions) { return estimate_spacing(positions).spacing; }

}  // namespace flowskin::scenes
