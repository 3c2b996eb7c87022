#include "tracking/repair/replace_region.h"

#include <algorithm>
#include <deque>
#include <initializer_list>
#include <iterator>
#include <map>
#include <utility>

#include "common/closest_point.h"
#include "tracking/extraction/marching_cubes.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/repair/improve_patch.h"
#include "tracking/repair/mesh_hole.h"
#include "tracking/repair/patch_crossings.h"
#include "tracking/repair/patch_mesh.h"
#include "tracking/repair/repair_limits.h"

namespace flowskin::tracking {
namespace {

// Fits the border of the hole into the fresh surface and takes what lies within.
class Filling {
 public:
  Filling(const FieldGrid& fresh, const CellSet& cells, SurfaceGeometry surface)
      : fresh_(fresh), cells_(cells), patch_(std::move(surface.positions), std::move(surface.triangles)) {}

  // False where some of the border does not fit; `misfit` tells all such places.
  bool fit(const MeshToMend& mesh, const std::vector<Side>& border, Misfit& misfit) {
    for (const Side& s : border) {
      if (vertex_in_patch_.count(s.first)) continue;
      const int vertex = patch_.insert(mesh.positions[s.first], mesh.normals[s.first],
                                       kRepairLimits.border_reach * fresh_.grid.spacing());
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
      if (leak < 0 && !meets(around, box.min, box.max)) leak = t;
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
    return meets(cells_, box.min, box.max);
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
      if (!(area.dot(normal) > kRepairLimits.same_sheet * area.norm())) continue;
      for (int vertex : mesh.triangles[k]) {
        if ((mesh.positions[vertex] - patch_.positions()[triangle[0]]).norm() <
            kRepairLimits.border_reach * fresh_.grid.spacing())
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

// Of the triangles around a hole, those that the patch does not remove, too.
std::vector<int> staying(const std::vector<int>& kept, const MeshPatch& patch) {
  std::vector<int> found;
  std::set_difference(kept.begin(), kept.end(), patch.removed.begin(), patch.removed.end(), std::back_inserter(found));
  return found;
}

// Where an evened patch is not any more where marching cubes put it: vertices of either that are far from the other.
std::vector<CellSet::Cell> strayed_cells(const FieldGrid& fresh, const MeshToMend& mesh, const MeshPatch& raw,
                                         const MeshPatch& evened) {
  const double reach = kRepairLimits.evened_within * fresh.grid.spacing();
  const SurfaceGeometry before = geometry_of(mesh, raw), after = geometry_of(mesh, evened);
  std::vector<CellSet::Cell> cells;
  const auto compare = [&](const std::vector<Vec3>& born, const SurfaceGeometry& other) {
    const ClosestPointTree tree(other.positions, other.triangles);
    for (const Vec3& x : born) {
      if (!tree.is_near(x, reach)) add_cells(fresh.grid.coordinates(x), fresh.grid.coordinates(x), cells);
    }
  };
  compare(raw.born, after);
  compare(evened.born, before);
  return cells;
}

// Where the rest of the mesh and the patch together miss vertices or triangle centres of the fresh surface: at its
// border the patch is made of the mesh's vertices, which may cut off a ridge.
std::vector<CellSet::Cell> missed_cells(const FieldGrid& fresh, const CellSet& cells, const SurfaceGeometry& expected,
                                        const SurfaceGeometry& found) {
  const double reach = kRepairLimits.missed * fresh.grid.spacing();
  const ClosestPointTree tree(found.positions, found.triangles);
  std::vector<CellSet::Cell> missed;
  const auto look_at = [&](const Vec3& x) {
    const Vec3 place = fresh.grid.coordinates(x);
    if (meets(cells, place, place) && !tree.is_near(x, reach)) add_cells(place, place, missed);
  };
  for (const Vec3& x : expected.positions) look_at(x);
  for (const Triangle& triangle : expected.triangles) look_at(triangle_center(expected.positions, triangle));
  return missed;
}

// The patch, evened out wherever that makes it intersect nothing and cuts no feature off; else the raw one.
MeshPatch improved(const FieldGrid& fresh, const MeshToMend& mesh, const std::vector<int>& kept, const MeshPatch& patch,
                   Misfit& misfit) {
  const PatchCrossings crossings(fresh.grid, mesh, kept);
  std::optional<MeshPatch> raw;
  for (const Finish finish : {Finish::evened, Finish::merged}) {
    CellSet frozen;
    for (int attempt = 0; attempt < kRepairLimits.freezings; ++attempt) {
      MeshPatch evened = patch;
      improve_patch(fresh, mesh, kept, finish, frozen, evened);
      std::vector<CellSet::Cell> bad = strayed_cells(fresh, mesh, patch, evened);
      const std::vector<CellSet::Cell> crossing = crossings.cells(evened);
      bad.insert(bad.end(), crossing.begin(), crossing.end());
      if (bad.empty()) return evened;
      if (!raw) {
        raw = patch;
        improve_patch(fresh, mesh, kept, Finish::raw, {}, *raw);
        misfit.cells = crossings.cells(*raw);
        // Where even the raw one intersects something, freezing does not help.
        if (!misfit.cells.empty()) {
          misfit.why = "the fresh surface passes through the rest of the mesh";
          return *raw;
        }
      }
      frozen = frozen.united(CellSet(std::move(bad)).dilated(attempt / 2));
    }
  }
  return *raw;
}

}  // namespace

Box box_of(const SparseGrid& grid, const Triangle& triangle, const std::vector<Vec3>& positions) {
  const Box box = bounding_box(positions, triangle);
  return {grid.coordinates(box.min), grid.coordinates(box.max)};
}

std::vector<Box> boxes_of(const SparseGrid& grid, const SurfaceMesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t t = 0; t < std::ssize(boxes); ++t) boxes[t] = box_of(grid, mesh.triangles[t], mesh.positions);
  return boxes;
}

std::optional<MeshPatch> replace_region(const FieldGrid& fresh, const CellSet& cells, const MeshToMend& mesh,
                                        Misfit& misfit) {
  misfit = {};
  MeshHole hole(cells, mesh);
  if (!hole.smooth_border(mesh, misfit)) return std::nullopt;
  const auto value = [&](const Vec3& x) { return fresh.field.value(x); };
  SurfaceGeometry surface = march(fresh.grid, cells.dilated(kRepairLimits.margin), value);
  const SurfaceGeometry expected = surface;
  Filling filling(fresh, cells, std::move(surface));
  const std::vector<int> kept = hole.kept();
  if (!filling.fit(mesh, hole.border(), misfit) || !filling.fill(mesh, hole.border(), kept, misfit))
    return std::nullopt;

  MeshPatch patch;
  patch.removed = hole.removed();
  filling.collect(static_cast<int>(mesh.positions.size()), patch);
  if (!fits_the_rest(fresh, mesh, kept, patch, misfit)) return std::nullopt;
  patch = improved(fresh, mesh, kept, patch, misfit);
  if (misfit.cells.empty()) {
    misfit.cells = missed_cells(fresh, cells.dilated(1), expected, geometry_of(mesh, patch, staying(kept, patch)));
    if (!misfit.cells.empty()) misfit.why = "the border of the hole cuts off a part of the fresh surface";
  }
  return patch;
}

}  // namespace flowskin::tracking
