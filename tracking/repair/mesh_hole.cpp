#include "tracking/repair/mesh_hole.h"

#include <algorithm>
#include <cmath>

#include "tracking/mesh/mesh_measures.h"
#include "tracking/repair/repair_limits.h"

namespace flowskin::tracking {
namespace {

constexpr int kSurroundings = 3;  // layers of cells around the hole that are looked at
constexpr int kPinchRounds = 30;

Box box_of(const CellSet& cells) {
  const auto corner = [](const CellSet::Cell& cell) { return Vec3(cell[0], cell[1], cell[2]); };
  return {corner(cells.low()), corner(cells.high()) + Vec3::Ones()};
}

bool is_narrow(const MeshToMend& mesh, int t) {
  return smallest_angle(mesh.positions, mesh.triangles[t]) < kRepairLimits.narrow_angle;
}

}  // namespace

MeshHole::MeshHole(const CellSet& cells, const MeshToMend& mesh) {
  const CellSet around = cells.dilated(kSurroundings), beside = cells.dilated(1);
  for (int t : mesh.bins.near(box_of(around))) {
    const Box& box = mesh.boxes[t];
    if (!mesh.alive[t] || !meets(around, box.min, box.max)) continue;
    const int n = static_cast<int>(near_.size());
    near_.push_back(t);
    is_removed_.push_back(meets(cells, box.min, box.max) || (is_narrow(mesh, t) && meets(beside, box.min, box.max)));
    for (int corner = 0; corner < 3; ++corner) owners_.push_back({side(mesh.triangles[t], corner), n});
  }
  std::sort(owners_.begin(), owners_.end());
  others_.assign(3 * near_.size(), -1);
  for (std::size_t n = 0; n < near_.size(); ++n) {
    for (int corner = 0; corner < 3; ++corner) {
      const Side s = side(mesh.triangles[near_[n]], corner);
      others_[3 * n + corner] = owner({s.second, s.first});
    }
  }
}

bool MeshHole::smooth_border(const MeshToMend& mesh, Misfit& misfit) {
  misfit.why = "the hole has no simple border";
  for (int round = 0; round < kPinchRounds; ++round) {
    if (!find_border(mesh, misfit)) return false;
    bool changed = remove_tongues();
    changed = remove_pinches() || changed;
    if (!changed) {
      misfit = {};
      return true;
    }
  }
  for (const Side& s : border_) {
    const Box& box = mesh.boxes[near_[owner(s)]];
    add_cells(box.min, box.max, misfit.cells);
  }
  return false;
}

std::vector<int> MeshHole::triangles(bool removed) const {
  std::vector<int> found;
  for (std::size_t n = 0; n < near_.size(); ++n) {
    if ((is_removed_[n] != 0) == removed) found.push_back(near_[n]);
  }
  return found;
}

// The number in near_ of the triangle that has a side in this direction, -1: none near.
int MeshHole::owner(const Side& s) const {
  const auto found = std::lower_bound(owners_.begin(), owners_.end(), std::pair(s, -1));
  return found != owners_.end() && found->first == s ? found->second : -1;
}

bool MeshHole::find_border(const MeshToMend& mesh, Misfit& misfit) {
  border_.clear();
  for (std::size_t n = 0; n < near_.size(); ++n) {
    if (!is_removed_[n]) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const int other = others_[3 * n + corner];
      if (other < 0) {
        add_cells(mesh.boxes[near_[n]].min, mesh.boxes[near_[n]].max, misfit.cells);
        return false;
      }
      if (!is_removed_[other]) border_.push_back(side(mesh.triangles[near_[n]], corner));
    }
  }
  return true;
}

// Triangles that stay with at most one neighbour.
bool MeshHole::remove_tongues() {
  bool any = false;
  for (std::size_t n = 0; n < near_.size(); ++n) {
    if (is_removed_[n]) continue;
    int open = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const int other = others_[3 * n + corner];
      open += other >= 0 && is_removed_[other];
    }
    if (open < 2) continue;
    is_removed_[n] = 1;
    any = true;
  }
  return any;
}

// All triangles at vertices through which the border runs twice.
bool MeshHole::remove_pinches() {
  std::vector<int> starts;
  for (const Side& s : border_) starts.push_back(s.first);
  std::sort(starts.begin(), starts.end());
  bool any = false;
  for (std::size_t i = 1; i < starts.size(); ++i) {
    if (starts[i] != starts[i - 1]) continue;
    // Each triangle at a vertex has one side that begins there.
    const Side first{starts[i], -1};
    for (auto next = std::lower_bound(owners_.begin(), owners_.end(), std::pair(first, -1));
         next != owners_.end() && next->first.first == starts[i]; ++next)
      is_removed_[next->second] = 1;
    any = true;
  }
  return any;
}

}  // namespace flowskin::tracking
