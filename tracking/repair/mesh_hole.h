// A hole in a mesh, and what is around it.
#pragma once

#include <utility>
#include <vector>

#include "tracking/extraction/cell_set.h"
#include "tracking/repair/replace_region.h"

namespace flowskin::tracking {

using Side = std::pair<int, int>;  ///< Of a triangle, from one corner to the next.

inline Side side(const Triangle& triangle, int corner) { return {triangle[corner], triangle[(corner + 1) % 3]}; }

/// The triangles that meet some cells, with the narrow ones beside them, and the surroundings.
class MeshHole {
 public:
  MeshHole(const CellSet& cells, const MeshToMend& mesh);

  /// Widens the hole until its border is made of simple loops. False where that leads out of the surroundings.
  bool smooth_border(const MeshToMend& mesh, Misfit& misfit);

  /// Sides of removed triangles whose other side stays.
  const std::vector<Side>& border() const { return border_; }
  std::vector<int> removed() const { return triangles(true); }
  /// Triangles near the hole that stay, ascending.
  std::vector<int> kept() const { return triangles(false); }

 private:
  std::vector<int> triangles(bool removed) const;
  int owner(const Side& s) const;
  bool find_border(const MeshToMend& mesh, Misfit& misfit);
  bool remove_tongues();
  bool remove_pinches();

  std::vector<int> near_;                     // triangles of the mesh, ascending
  std::vector<char> is_removed_;              // one each
  std::vector<std::pair<Side, int>> owners_;  // of each side, its number in near_; ascending
  std::vector<int> others_;  // across side `corner` of near_[n], at 3 n + corner: number in near_; -1: not near
  std::vector<Side> border_;
};

}  // namespace flowskin::tracking
