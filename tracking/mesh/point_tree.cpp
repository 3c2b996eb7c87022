#include "tracking/mesh/point_tree.h"

#include <utility>

namespace flowskin::tracking {
namespace {

// Number of the nearest candidate among `targets` for each query, -1: none.
std::vector<int> nearest_candidates(const SurfacePoints& targets, const SurfacePoints& queries, double reach,
                                    double cosine) {
  std::vector<int> result(queries.places.size(), -1);
  if (targets.places.empty()) return result;
  const PointCloud cloud{targets.places};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  const nanoflann::SearchParams nearest_first;
#pragma omp parallel for schedule(static)
  for (int q = 0; q < static_cast<int>(queries.places.size()); ++q) {
    std::vector<std::pair<int, double>> found;
    tree.radiusSearch(queries.places[q].data(), reach * reach, found, nearest_first);
    for (const auto& [candidate, squared] : found) {
      if (!(targets.normals[candidate].dot(queries.normals[q]) > cosine)) continue;
      result[q] = candidate;
      break;
    }
  }
  return result;
}

}  // namespace

std::vector<int> paired_points(const SurfacePoints& first, const SurfacePoints& second, double reach, double cosine) {
  std::vector<int> first_of_second = nearest_candidates(first, second, reach, cosine);
  const std::vector<int> second_of_first = nearest_candidates(second, first, reach, cosine);
  for (int p = 0; p < std::ssize(first_of_second); ++p) {
    int& partner = first_of_second[p];
    if (partner >= 0 && second_of_first[partner] != p) partner = -1;
  }
  return first_of_second;
}

}  // namespace flowskin::tracking
