// Finds the triangles of a mesh near a region of the grid.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/triangle_tree.h"

namespace flowskin::tracking {

/// Triangles by cubes of kSide cells that their boxes meet; more may be added at any time.
class TriangleBins {
 public:
  static constexpr int kSide = 8;

  /// @param box in grid coordinates (see SparseGrid::coordinates)
  void add(int triangle, const Box& box);

  /// All triangles whose boxes meet this one, and some more that are near: ascending, each once.
  std::vector<int> near(const Box& box) const;

 private:
  std::unordered_map<std::uint64_t, std::vector<int>> bins_;
};

}  // namespace flowskin::tracking
