#include "tracking/repair/improve_patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/closest_point.h"
#include "tracking/advection/projection.h"
#include "tracking/extraction/improvement_limits.h"
#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/edges_by_length.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/keep_vertices.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/point_tree.h"
#include "tracking/repair/patch_crossings.h"
#include "tracking/repair/repair_limits.h"

namespace flowskin::tracking {
namespace {

using namespace improvement;

// The patch and the triangles around it, with numbers of their own: old vertices first, then the new ones.
class LocalMesh {
 public:
  LocalMesh(const MeshToMend& whole, const std::vector<int>& kept, const MeshPatch& patch)
      : mesh_size_(static_cast<int>(whole.positions.size())) {
    std::vector<int> border;
    for (const Triangle& triangle : patch.triangles) {
      for (int vertex : triangle) {
        if (vertex < mesh_size_) border.push_back(vertex);
      }
    }
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    for (int t : kept) {
      const auto& [a, b, c] = whole.triangles[t];
      const auto on_border = [&](int vertex) { return std::binary_search(border.begin(), border.end(), vertex); };
      if (!on_border(a) && !on_border(b) && !on_border(c)) continue;
      ring_.push_back(t);
      for (int vertex : whole.triangles[t]) border_and_ring_.push_back(vertex);
    }
    border_and_ring_.insert(border_and_ring_.end(), border.begin(), border.end());
    std::sort(border_and_ring_.begin(), border_and_ring_.end());
    border_and_ring_.erase(std::unique(border_and_ring_.begin(), border_and_ring_.end()), border_and_ring_.end());
    old_count_ = static_cast<int>(border_and_ring_.size());
    for (int vertex : border_and_ring_) {
      positions_.push_back(whole.positions[vertex]);
      normals_.push_back(whole.normals[vertex]);
    }
    positions_.insert(positions_.end(), patch.born.begin(), patch.born.end());
    normals_.resize(positions_.size(), Vec3::Zero());
    for (int t : ring_) triangles_.push_back(local(whole.triangles[t]));
    for (const Triangle& triangle : patch.triangles) triangles_.push_back(local(triangle));
    is_frozen_.assign(positions_.size(), 0);
  }

  // New vertices in these cells stay as they are.
  void freeze(const SparseGrid& grid, const CellSet& cells) {
    if (cells.empty()) return;
    for (int v = old_count_; v < static_cast<int>(positions_.size()); ++v) {
      const Vec3 x = grid.coordinates(positions_[v]);
      is_frozen_[v] = meets(cells, x, x);
    }
  }

  // Vertices of the mesh that the patch would drop, in ascending order.
  std::vector<int> dropped(const MeshToMend& whole, const MeshPatch& patch) const {
    std::vector<int> found;
    for (int t : patch.removed) {
      for (int vertex : whole.triangles[t]) {
        if (!std::binary_search(border_and_ring_.begin(), border_and_ring_.end(), vertex)) found.push_back(vertex);
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  // A new vertex becomes one of the mesh.
  void make_old(int vertex, int of_mesh) {
    old_of_new_.resize(positions_.size(), -1);
    old_of_new_[vertex] = of_mesh;
  }

  int old_count() const { return old_count_; }
  bool is_frozen(int vertex) const { return is_frozen_[vertex] != 0; }
  // New, and not frozen.
  bool is_free(int vertex) const { return vertex >= old_count_ && !is_frozen(vertex); }
  std::vector<int> free_vertices() const {
    std::vector<int> found;
    for (int v = old_count_; v < static_cast<int>(positions_.size()); ++v) {
      if (is_free(v)) found.push_back(v);
    }
    return found;
  }
  std::vector<Vec3>& positions() { return positions_; }
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::vector<Vec3>& normals() { return normals_; }
  std::vector<Triangle>& triangles() { return triangles_; }
  MeshAdjacency topology() const { return build_adjacency(static_cast<int>(positions_.size()), triangles_); }

  // Without the vertices that edits removed; these are new ones.
  void compact(EditableMesh& editable) {
    const std::vector<int> number = editable.compact();
    keep_numbered(number, normals_);
    keep_numbered(number, is_frozen_);
  }

  // The patch, now with the triangles around it.
  void hand_over(MeshPatch& patch) const {
    patch.removed.insert(patch.removed.end(), ring_.begin(), ring_.end());
    std::sort(patch.removed.begin(), patch.removed.end());
    patch.born.clear();
    patch.born_normals.clear();
    std::vector<int> number = border_and_ring_;
    for (int v = old_count_; v < static_cast<int>(positions_.size()); ++v) {
      const int old = old_of_new_.empty() ? -1 : old_of_new_[v];
      number.push_back(old >= 0 ? old : mesh_size_ + static_cast<int>(patch.born.size()));
      if (old >= 0) continue;
      patch.born.push_back(positions_[v]);
      patch.born_normals.push_back(normals_[v]);
    }
    patch.triangles.clear();
    for (const Triangle& triangle : triangles_)
      patch.triangles.push_back({number[triangle[0]], number[triangle[1]], number[triangle[2]]});
  }

 private:
  Triangle local(Triangle triangle) const {
    for (int& vertex : triangle) {
      if (vertex >= mesh_size_) {
        vertex += old_count_ - mesh_size_;
      } else {
        const auto found = std::lower_bound(border_and_ring_.begin(), border_and_ring_.end(), vertex);
        vertex = static_cast<int>(found - border_and_ring_.begin());
      }
    }
    return triangle;
  }

  int mesh_size_, old_count_ = 0;
  std::vector<int> border_and_ring_;  // old vertices, ascending
  std::vector<int> ring_;             // old triangles that touch the patch
  std::vector<Vec3> positions_, normals_;
  std::vector<Triangle> triangles_;
  std::vector<char> is_frozen_;
  std::vector<int> old_of_new_;  // the mesh's vertex that each has become, -1: none; empty: none has
};

// Whether the triangles at a vertex stay well shaped and upright when it moves to x.
bool may_move(const LocalMesh& mesh, const MeshAdjacency& topology, int vertex, const Vec3& x, double edge_length) {
  for (int t : topology.star(vertex)) {
    const Triangle& triangle = mesh.triangles()[t];
    std::array<Vec3, 3> after{};
    for (int i = 0; i < 3; ++i) after[i] = triangle[i] == vertex ? x : mesh.positions()[triangle[i]];
    const Vec3 before = doubled_area_vector(mesh.positions(), triangle);
    const Vec3 area = (after[1] - after[0]).cross(after[2] - after[0]);
    if (!(area.dot(before) > kRepairLimits.same_vertex_turn * area.norm() * before.norm())) return false;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = after[i], &b = after[(i + 1) % 3], &c = after[(i + 2) % 3];
      const double length = (b - a).norm();
      if (length < kShortEdge * edge_length || length > kLongEdge * edge_length) return false;
      if (angle_at(a, b, c) < kRepairLimits.same_vertex_angle) return false;
    }
  }
  return true;
}

// New vertices that come to lie next to one that the patch would drop, each the other's nearest, move there: so that
// vertex stays, with its id and all that it carries.
void keep_old_vertices(const FieldGrid& fresh, const MeshToMend& whole, const MeshPatch& patch, LocalMesh& mesh) {
  const double edge_length = fresh.grid.spacing();
  const double tolerance = default_projection(fresh.field.scale()).tolerance;
  std::vector<int> dropped = mesh.dropped(whole, patch);
  const SurfaceGeometry raw = geometry_of(whole, patch);
  const ClosestPointTree fresh_surface(raw.positions, raw.triangles);
  std::erase_if(dropped, [&](int vertex) {
    const Vec3& x = whole.positions[vertex];
    return !fresh_surface.is_near(x, kRepairLimits.same_vertex_off_surface * edge_length) ||
           !(surface_distance(fresh.field, x).distance <= tolerance);
  });
  const int first = mesh.old_count(), count = static_cast<int>(mesh.positions().size());
  if (dropped.empty() || first == count) return;
  std::vector<Vec3> old_places, old_normals;
  for (int vertex : dropped) {
    old_places.push_back(whole.positions[vertex]);
    old_normals.push_back(whole.normals[vertex]);
  }
  const std::vector<Vec3> places(mesh.positions().begin() + first, mesh.positions().end());
  const std::vector<Vec3> normals(mesh.normals().begin() + first, mesh.normals().end());
  const std::vector<int> old_of =
      paired_points({old_places, old_normals}, {places, normals}, kRepairLimits.same_vertex * edge_length,
                    kRepairLimits.same_vertex_normals);
  const MeshAdjacency topology = mesh.topology();
  for (int v = first; v < count; ++v) {
    if (!mesh.is_free(v) || old_of[v - first] < 0) continue;
    const int vertex = dropped[old_of[v - first]];
    if (!may_move(mesh, topology, v, whole.positions[vertex], edge_length)) continue;
    mesh.positions()[v] = whole.positions[vertex];
    mesh.make_old(v, vertex);
  }
}

void collapse_short_edges(double edge_length, LocalMesh& mesh) {
  const MeshAdjacency topology = mesh.topology();
  const std::vector<int> order =
      edges_by_length(topology, mesh.positions(), EdgeOrder::shortest_first, [&](int e, double length) {
        return length < kShortEdge * edge_length &&
               (mesh.is_free(topology.edges[e][0]) || mesh.is_free(topology.edges[e][1]));
      });
  if (order.empty()) return;
  const double longest = kLongEdge * edge_length;
  const double volume = kLargestCollapse * longest * longest * longest;
  EditableMesh editable(mesh.positions(), mesh.triangles());
  for (int e : order) {
    const auto& [low, high] = topology.edges[e];
    if (mesh.is_free(high) && editable.collapse(low, high, longest, volume)) continue;
    if (mesh.is_free(low)) editable.collapse(high, low, longest, volume);
  }
  mesh.compact(editable);
}

void flip_towards_delaunay(LocalMesh& mesh) {
  const MeshAdjacency topology = mesh.topology();
  EditableMesh editable(mesh.positions(), mesh.triangles());
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto& [a, b] = topology.edges[e];
    const auto& [first, second] = topology.edge_triangles[e];
    if (second < 0) continue;
    bool is_free = false, is_frozen = false;
    for (int t : {first, second}) {
      for (int vertex : mesh.triangles()[t]) {
        is_free = is_free || mesh.is_free(vertex);
        is_frozen = is_frozen || mesh.is_frozen(vertex);
      }
    }
    if (is_free && !is_frozen && editable.wants_flip(a, b)) editable.flip(a, b);
  }
}

}  // namespace

void improve_patch(const FieldGrid& fresh, const MeshToMend& whole, const std::vector<int>& kept, Finish finish,
                   const CellSet& frozen, MeshPatch& patch) {
  const double edge_length = fresh.grid.spacing();
  const ProjectionSettings projection = default_projection(fresh.field.scale());
  LocalMesh mesh(whole, kept, patch);
  mesh.freeze(fresh.grid, frozen);
  for (int v = mesh.old_count(); v < static_cast<int>(mesh.positions().size()); ++v) {
    SurfaceDistance point;
    project_point(fresh.field, projection, mesh.positions()[v], point);
    mesh.normals()[v] = point.normal;
  }
  const int rounds = finish == Finish::evened ? kRounds : 0;
  for (int round = 0; round < rounds; ++round) {
    collapse_short_edges(edge_length, mesh);
    flip_towards_delaunay(mesh);
    const std::vector<int> moving = mesh.free_vertices();
    if (moving.empty()) break;
    relax(fresh.field, projection, mesh.topology(), mesh.triangles(), kRelaxationsPerRound, moving, mesh.positions(),
          mesh.normals(), Ridges::kept);
  }
  if (finish != Finish::raw) {
    collapse_short_edges(edge_length, mesh);
    flip_towards_delaunay(mesh);
    keep_old_vertices(fresh, whole, patch, mesh);
  }
  mesh.hand_over(patch);
}

}  // namespace flowskin::tracking
