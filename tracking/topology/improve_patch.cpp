#include "tracking/topology/improve_patch.h"

#include <algorithm>

#include "tracking/advection/projection.h"
#include "tracking/extraction/improvement_limits.h"
#include "tracking/fairing/relaxation.h"
#include "tracking/mesh/edges_by_length.h"
#include "tracking/mesh/editable_mesh.h"
#include "tracking/mesh/keep_vertices.h"

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
  }

  int old_count() const { return old_count_; }
  bool is_new(int vertex) const { return vertex >= old_count_; }
  std::vector<Vec3>& positions() { return positions_; }
  std::vector<Vec3>& normals() { return normals_; }
  std::vector<Triangle>& triangles() { return triangles_; }
  MeshTopology topology() const { return build_topology(static_cast<int>(positions_.size()), triangles_); }

  // Without the vertices that edits removed; these are new ones.
  void compact(EditableMesh& editable) { keep_numbered(editable.compact(), normals_); }

  // The patch, now with the triangles around it.
  void hand_over(MeshPatch& patch) const {
    patch.removed.insert(patch.removed.end(), ring_.begin(), ring_.end());
    std::sort(patch.removed.begin(), patch.removed.end());
    patch.born.assign(positions_.begin() + old_count_, positions_.end());
    patch.born_normals.assign(normals_.begin() + old_count_, normals_.end());
    patch.triangles.clear();
    for (const Triangle& triangle : triangles_) {
      Triangle global{};
      for (int i = 0; i < 3; ++i) {
        global[i] = is_new(triangle[i]) ? mesh_size_ + triangle[i] - old_count_ : border_and_ring_[triangle[i]];
      }
      patch.triangles.push_back(global);
    }
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
};

void collapse_short_edges(double edge_length, LocalMesh& mesh) {
  const MeshTopology topology = mesh.topology();
  const std::vector<int> order = edges_by_length(
      topology, mesh.positions(), EdgeOrder::shortest_first,
      [&](int e, double length) { return length < kShortEdge * edge_length && mesh.is_new(topology.edges[e][1]); });
  if (order.empty()) return;
  const double longest = kLongEdge * edge_length;
  const double volume = kLargestCollapse * longest * longest * longest;
  EditableMesh editable(mesh.positions(), mesh.triangles());
  for (int e : order) {
    const auto& [low, high] = topology.edges[e];
    if (editable.collapse(low, high, longest, volume)) continue;
    if (mesh.is_new(low)) editable.collapse(high, low, longest, volume);
  }
  mesh.compact(editable);
}

void flip_towards_delaunay(LocalMesh& mesh) {
  const MeshTopology topology = mesh.topology();
  EditableMesh editable(mesh.positions(), mesh.triangles());
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto& [a, b] = topology.edges[e];
    const auto& [first, second] = topology.edge_triangles[e];
    if (second < 0) continue;
    bool touches_new = false;
    for (int t : {first, second}) {
      for (int vertex : mesh.triangles()[t]) touches_new = touches_new || mesh.is_new(vertex);
    }
    if (touches_new && editable.wants_flip(a, b)) editable.flip(a, b);
  }
}

}  // namespace

void improve_patch(const FieldGrid& fresh, const MeshToMend& whole, const std::vector<int>& kept, Finish finish,
                   MeshPatch& patch) {
  const double edge_length = fresh.grid.spacing();
  const ProjectionSettings projection = default_projection(fresh.field.settings());
  LocalMesh mesh(whole, kept, patch);
  for (int v = mesh.old_count(); v < static_cast<int>(mesh.positions().size()); ++v) {
    SurfaceDistance point;
    project_point(fresh.field, projection, mesh.positions()[v], point);
    mesh.normals()[v] = point.normal;
  }
  for (int round = 0; round < (finish == Finish::evened ? kRounds : 0); ++round) {
    collapse_short_edges(edge_length, mesh);
    flip_towards_delaunay(mesh);
    std::vector<int> moving;
    for (int v = mesh.old_count(); v < static_cast<int>(mesh.positions().size()); ++v) moving.push_back(v);
    if (moving.empty()) break;
    relax(fresh.field, projection, mesh.topology(), mesh.triangles(), kRelaxationsPerRound, moving, mesh.positions(),
          mesh.normals(), Ridges::kept);
  }
  collapse_short_edges(edge_length, mesh);
  flip_towards_delaunay(mesh);
  mesh.hand_over(patch);
}

}  // namespace flowskin::tracking
