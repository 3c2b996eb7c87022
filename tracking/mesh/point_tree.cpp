#include "tracking/mesh/point_tree.h"

namespace flowskin::tracking {

std::vector<int> nearest_points(const std::vector<Vec3>& targets, const std::vector<Vec3>& queries, double reach) {
  std::vector<int> result(queries.size(), -1);
  if (targets.empty()) return result;
  const PointCloud cloud{targets};
  const PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
#pragma omp parallel for schedule(static)
  for (int q = 0; q < static_cast<int>(queries.size()); ++q) {
    int index = -1;
    double squared = 0;
    if (tree.knnSearch(queries[q].data(), 1, &index, &squared) == 1 && squared <= reach * reach) result[q] = index;
  }
  return result;
}

}  // namespace flowskin::tracking
