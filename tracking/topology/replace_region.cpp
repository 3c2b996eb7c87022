#include "tracking/topology/replace_region.h"

#include <algorithm>
#include <deque>
#include <initializer_list>
#include <map>
#include <utility>

#include "tracking/extraction/marching_cubes.h"
#include "tracking/mesh/closest_point.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/topology/improve_patch.h"
#include "tracking/topology/patch_crossings.h"
#include "tracking/topology/patch_mesh.h"

namespace flowskin::tracking {
namespace {

constexpr int kSurroundings = 3;   // layers of cells around the hole that are looked at
constexpr int kMargin = 3;         // layers of cells by which the fresh surface overlaps the rest of the mesh
constexpr double kReach = 0.75;    // between the two surfaces at the border, in cells
constexpr double kSameSide = 0.5;  // cosine between normals of one sheet
constexpr double kNear = 0.4;      // cells that evening may carry the surface away from where marching cubes put it
constexpr int kFreezings = 5;      // of places where evening does harm
constexpr int kPinchRounds = 30;

using Side = std::pair<int, int>;  // of a triangle, from one corner to the next

Side side(const Triangle& triangle, int corner) { return {triangle[corner], triangle[(corner + 1) % 3]}; }

// The surroundings of the hole, and the hole.
class Hole {
 public:
  Hole(const CellSet& cells, const MeshToMend& mesh) {
    const CellSet around = cells.dilated(kSurroundings);
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      const Box& box = mesh.boxes[t];
      if (!mesh.alive[t] || !meets(around, box.low, box.high)) continue;
      near_.push_back(t);
      is_removed_.push_back(meets(cells, box.low, box.high));
      for (int corner = 0; corner < 3; ++corner) {
        owner_[side(mesh.triangles[t], corner)] = static_cast<int>(near_.size()) - 1;
        stars_[mesh.triangles[t][corner]].push_back(static_cast<int>(near_.size()) - 1);
      }
    }
  }

  // Widens the hole until its border is made of simple loops. False where that leads out of the surroundings.
  bool smooth_border(const MeshToMend& mesh, Misfit& misfit) {
    misfit.why = "the hole has no simple border";
    for (int round = 0; round < kPinchRounds; ++round) {
      if (!find_border(mesh, misfit)) return false;
      std::map<int, int> starts;
      for (const Side& s : border_) ++starts[s.first];
      bool changed = remove_tongues(mesh);
      for (const auto& [vertex, count] : starts) {
        if (count < 2) continue;
        for (int n : stars_[vertex]) is_removed_[n] = 1;
        changed = true;
      }
      if (!changed) {
        misfit = {};
        return true;
      }
    }
    for (const Side& s : border_)
      add_cells(mesh.boxes[near_[owner_.at(s)]].low, mesh.boxes[near_[owner_.at(s)]].high, misfit.cells);
    return false;
  }

  // Sides of removed triangles whose other side stays.
  const std::vector<Side>& border() const { return border_; }

  std::vector<int> removed() const { return triangles(true); }
  // Triangles near the hole that stay.
  std::vector<int> kept() const { return triangles(false); }

 private:
  std::vector<int> triangles(bool removed) const {
    std::vector<int> found;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if ((is_removed_[n] != 0) == removed) found.push_back(near_[n]);
    }
    return found;
  }

  bool find_border(const MeshToMend& mesh, Misfit& misfit) {
    border_.clear();
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if (!is_removed_[n]) continue;
      for (int corner = 0; corner < 3; ++corner) {
        const Side s = side(mesh.triangles[near_[n]], corner);
        const auto other = owner_.find({s.second, s.first});
        if (other == owner_.end()) {
          add_cells(mesh.boxes[near_[n]].low, mesh.boxes[near_[n]].high, misfit.cells);
          return false;
        }
        if (!is_removed_[other->second]) border_.push_back(s);
      }
    }
    return true;
  }

  // Triangles that stay with at most one neighbour.
  bool remove_tongues(const MeshToMend& mesh) {
    bool any = false;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if (is_removed_[n]) continue;
      int open = 0;
      for (int corner = 0; corner < 3; ++corner) {
        const Side s = side(mesh.triangles[near_[n]], corner);
        const auto other = owner_.find({s.second, s.first});
        open += other != owner_.end() && is_removed_[other->second];
      }
      if (open < 2) continue;
      is_removed_[n] = 1;
      any = true;
    }
    return any;
  }

  std::vector<int> near_;         // triangles of the mesh
  std::vector<char> is_removed_;  // one each
  std::map<Side, int> owner_;     // number in near_
  std::map<int, std::vector<int>> stars_;
  std::vector<Side> border_;
};

// Fits the border of the hole into the fresh surface and takes what lies within.
class Filling {
 public:
  Filling(const FieldGrid& fresh, const CellSet& cells, SurfaceGeometry surface)
      : fresh_(fresh), cells_(cells), patch_(std::move(surface.positions), std::move(surface.triangles)) {}

  // False where some of the border does not fit; `misfit` tells all such places.
  bool fit(const MeshToMend& mesh, const std::vector<Side>& border, Misfit& misfit) {
    for (const Side& s : border) {
      if (vertex_in_patch_.count(s.first)) continue;
      const int vertex = patch_.insert(mesh.positions[s.first], mesh.normals[s.first], kReach * fresh_.grid.spacing());
      if (vertex >= 0) {
        vertex_in_patch_[s.first] = vertex;
      } else {
        refuse("the fresh surface does not reach the border of the hole", {mesh.positions[s.first]}, misfit);
      }
    }
    for (const Side& s : border) {
      const auto from = vertex_in_patch_.find(s.first), to = vertex_in_patch_.find(s.second);
      if (from == vertex_in_patch_.end() || to == vertex_in_patch_.end()) continue;
      const Vec3 normal = mesh.normals[s.first] + mesh.normals[s.second];
      if (!patch_.connect(from->second, to->second, normal))
        refuse("the border of the hole cannot be drawn on the fresh surface",
               {mesh.positions[s.first], mesh.positions[s.second]}, misfit);
    }
    return misfit.cells.empty();
  }

  // Marks the triangles within the border. False where the border does not part inside and outside.
  bool fill(const MeshToMend& mesh, const std::vector<Side>& border, const std::vector<int>& kept, Misfit& misfit) {
    std::vector<int> open;
    is_inside_.assign(patch_.triangles().size(), 0);
    for (const Side& s : border)
      open.push_back(patch_.triangle_at(vertex_in_patch_[s.first], vertex_in_patch_[s.second]));
    if (!flood({open.begin(), open.end()}, misfit)) return false;
    for (const Side& s : border) {
      if (!is_inside_[patch_.triangle_at(vertex_in_patch_[s.second], vertex_in_patch_[s.first])]) continue;
      refuse("the border of the hole does not part inside and outside",
             {mesh.positions[s.first], mesh.positions[s.second]}, misfit);
    }
    return misfit.cells.empty() && add_new_parts(mesh, kept, misfit);
  }

  // The triangles within, with vertices of the mesh by their numbers, new ones from `first_new` on.
  void collect(int first_new, MeshPatch& result) const {
    std::vector<int> number(patch_.positions().size(), -1);
    for (const auto& [old, vertex] : vertex_in_patch_) number[vertex] = old;
    for (std::size_t t = 0; t < patch_.triangles().size(); ++t) {
      if (!is_inside_[t]) continue;
      Triangle triangle = patch_.triangles()[t];
      for (int& vertex : triangle) {
        if (number[vertex] < 0) {
          number[vertex] = first_new + static_cast<int>(result.born.size());
          result.born.push_back(patch_.positions()[vertex]);
        }
        vertex = number[vertex];
      }
      result.triangles.push_back(triangle);
    }
  }

 private:
  void refuse(const char* why, std::initializer_list<Vec3> places, Misfit& misfit) const {
    misfit.why = why;
    for (const Vec3& x : places) add_cells(fresh_.grid.coordinates(x), fresh_.grid.coordinates(x), misfit.cells);
  }

  // Goes from these triangles over all edges but the fixed ones. False where it meets the end of the surface.
  bool flood(std::deque<int> open, Misfit& misfit) {
    const CellSet around = cells_.dilated(1);
    int leak = -1;  // the first triangle on the way out
    for (int t : open) is_inside_[t] = 1;
    while (!open.empty()) {
      const int t = open.front();
      const Triangle triangle = patch_.triangles()[t];
      open.pop_front();
      const Box box = box_of(fresh_.grid, triangle, patch_.positions());
      if (leak < 0 && !meets(around, box.low, box.high)) leak = t;
      for (int corner = 0; corner < 3; ++corner) {
        const auto [a, b] = side(triangle, corner);
        if (patch_.is_fixed(a, b)) continue;
        const int next = patch_.triangle_at(b, a);
        if (next < 0) {
          refuse("the fresh surface leaves the region",
                 {patch_.positions()[patch_.triangles()[leak < 0 ? t : leak][0]]}, misfit);
          return false;
        }
        if (!std::exchange(is_inside_[next], 1)) open.push_back(next);
      }
    }
    return true;
  }

  bool meets_cells(int t) const {
    const Box box = box_of(fresh_.grid, patch_.triangles()[t], patch_.positions());
    return meets(cells_, box.low, box.high);
  }

  // Closed parts of the fresh surface that lie in the region and have no counterpart in the mesh.
  bool add_new_parts(const MeshToMend& mesh, const std::vector<int>& kept, Misfit& misfit) {
    const MeshComponents parts = mesh_components(patch_.positions(), patch_.triangles());
    std::vector<char> candidate(parts.count, 0);
    for (std::size_t t = 0; t < patch_.triangles().size(); ++t) {
      if (meets_cells(static_cast<int>(t))) candidate[parts.of_vertex[patch_.triangles()[t][0]]] = 1;
    }
    for (std::size_t t = 0; t < patch_.triangles().size(); ++t) {
      const Triangle& triangle = patch_.triangles()[t];
      char& wanted = candidate[parts.of_vertex[triangle[0]]];
      if (is_inside_[t]) wanted = 0;
      for (int corner = 0; corner < 3; ++corner) {
        const auto [a, b] = side(triangle, corner);
        if (patch_.triangle_at(b, a) < 0) wanted = 0;
      }
    }
    for (const auto& [old, vertex] : vertex_in_patch_) candidate[parts.of_vertex[vertex]] = 0;
    for (std::size_t t = 0; t < patch_.triangles().size(); ++t) {
      if (!candidate[parts.of_vertex[patch_.triangles()[t][0]]]) continue;
      if (has_counterpart(mesh, kept, static_cast<int>(t))) {
        refuse("a small part lies half in the region", {patch_.positions()[patch_.triangles()[t][0]]}, misfit);
      }
      is_inside_[t] = 1;
    }
    return misfit.cells.empty();
  }

  // Whether a triangle that stays lies next to this one, on the same side.
  bool has_counterpart(const MeshToMend& mesh, const std::vector<int>& kept, int t) const {
    const Triangle& triangle = patch_.triangles()[t];
    const Vec3 normal = doubled_area_vector(patch_.positions(), triangle).normalized();
    for (int k : kept) {
      const Vec3 area = doubled_area_vector(mesh.positions, mesh.triangles[k]);
      if (!(area.dot(normal) > kSameSide * area.norm())) continue;
      for (int vertex : mesh.triangles[k]) {
        if ((mesh.positions[vertex] - patch_.positions()[triangle[0]]).norm() < kReach * fresh_.grid.spacing())
          return true;
      }
    }
    return false;
  }

  const FieldGrid& fresh_;
  const CellSet& cells_;
  PatchMesh patch_;
  std::map<int, int> vertex_in_patch_;  // of the border's vertices
  std::vector<char> is_inside_;
};

// The rest of the mesh may already have an edge that the filling has, too.
bool fits_the_rest(const FieldGrid& fresh, const MeshToMend& mesh, const std::vector<int>& kept, const MeshPatch& patch,
                   Misfit& misfit) {
  std::vector<Side> sides;
  for (int t : kept) {
    for (int corner = 0; corner < 3; ++corner) sides.push_back(side(mesh.triangles[t], corner));
  }
  for (const Triangle& triangle : patch.triangles) {
    for (int corner = 0; corner < 3; ++corner) sides.push_back(side(triangle, corner));
  }
  std::sort(sides.begin(), sides.end());
  const auto found = std::adjacent_find(sides.begin(), sides.end());
  if (found == sides.end()) return true;
  misfit.why = "the fresh surface has an edge that the mesh has, too";
  for (int vertex : {found->first, found->second}) {
    const Vec3 x = fresh.grid.coordinates(mesh.positions[vertex]);
    add_cells(x, x, misfit.cells);
  }
  return false;
}

// Where an evened patch is not any more where marching cubes put it: vertices of either that are far from the other.
std::vector<CellSet::Cell> strayed_cells(const FieldGrid& fresh, const MeshToMend& mesh, const MeshPatch& raw,
                                         const MeshPatch& evened) {
  const double reach = kNear * fresh.grid.spacing();
  const SurfaceGeometry before = geometry_of(mesh, raw), after = geometry_of(mesh, evened);
  std::vector<CellSet::Cell> cells;
  const auto compare = [&](const std::vector<Vec3>& born, const SurfaceGeometry& other) {
    const ClosestPointTree tree(other.positions, other.triangles);
    for (const Vec3& x : born) {
      if (tree.distance(x, reach) > reach) add_cells(fresh.grid.coordinates(x), fresh.grid.coordinates(x), cells);
    }
  };
  compare(raw.born, after);
  compare(evened.born, before);
  return cells;
}

// The patch, evened out wherever that makes it intersect nothing and cuts no feature off; else the raw one.
MeshPatch improved(const FieldGrid& fresh, const MeshToMend& mesh, const std::vector<int>& kept, const MeshPatch& patch,
                   Misfit& misfit) {
  const PatchCrossings crossings(fresh.grid, mesh, kept);
  MeshPatch best;
  for (const Finish finish : {Finish::evened, Finish::merged}) {
    CellSet frozen;
    for (int attempt = 0; attempt < kFreezings; ++attempt) {
      best = patch;
      improve_patch(fresh, mesh, kept, finish, frozen, best);
      std::vector<CellSet::Cell> bad = strayed_cells(fresh, mesh, patch, best);
      const std::vector<CellSet::Cell> crossing = crossings.cells(best);
      bad.insert(bad.end(), crossing.begin(), crossing.end());
      if (bad.empty()) return best;
      const CellSet wider = CellSet(std::move(bad)).dilated(attempt / 2);
      std::vector<CellSet::Cell> all = frozen.cells();
      all.insert(all.end(), wider.cells().begin(), wider.cells().end());
      frozen = CellSet(std::move(all));
    }
  }
  best = patch;
  improve_patch(fresh, mesh, kept, Finish::raw, {}, best);
  misfit.cells = crossings.cells(best);
  if (!misfit.cells.empty()) misfit.why = "the fresh surface passes through the rest of the mesh";
  return best;
}

}  // namespace

Box box_of(const SparseGrid& grid, const Triangle& triangle, const std::vector<Vec3>& positions) {
  const Box box = bounding_box(positions, triangle);
  return {grid.coordinates(box.low), grid.coordinates(box.high)};
}

std::optional<MeshPatch> replace_region(const FieldGrid& fresh, const CellSet& cells, const MeshToMend& mesh,
                                        Misfit& misfit) {
  misfit = {};
  Hole hole(cells, mesh);
  if (!hole.smooth_border(mesh, misfit)) return std::nullopt;
  const auto value = [&](const Vec3& x) { return fresh.field.value(x); };
  Filling filling(fresh, cells, march(fresh.grid, cells.dilated(kMargin), value));
  const std::vector<int> kept = hole.kept();
  if (!filling.fit(mesh, hole.border(), misfit) || !filling.fill(mesh, hole.border(), kept, misfit))
    return std::nullopt;

  MeshPatch patch;
  patch.removed = hole.removed();
  filling.collect(static_cast<int>(mesh.positions.size()), patch);
  if (!fits_the_rest(fresh, mesh, kept, patch, misfit)) return std::nullopt;
  return improved(fresh, mesh, kept, patch, misfit);
}

}  // namespace flowskin::tracking
