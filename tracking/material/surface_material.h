// Where the material between the vertices of a surface is: for vertices that slide over it, and for new ones.
#pragma once

#include <array>
#include <vector>

#include "tracking/mesh/adjacency.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Times the length of an edge: where the material of its ends was so much farther apart, two bodies have met.
inline constexpr double kTornEdge = 3;

/// A surface whose vertices know something; keeps references to all.
struct KnownSurface {
  const std::vector<Vec3>& positions;
  const MeshAdjacency& adjacency;
  const std::vector<Vec3>& normals;  ///< Of unit length, at the vertices.
};

/// Interpolates places of the material (m) around a vertex of a surface: a polynomial of second degree over the tangent
/// plane, through the value at the vertex, fitted to its two rings by weighted least squares; about the affine map that
/// the first derivatives give, which takes normals to normals. The error is of third order in the distance of the
/// vertices; there is none where the material has moved rigidly.
class MaterialChart {
 public:
  /// @param places of the material, one per vertex: they decide which neighbours are of one body with the vertex
  MaterialChart(const KnownSurface& surface, int vertex, const std::vector<Vec3>& places);

  /// The point of the surface that x lies above or below.
  Vec3 on_surface(const Vec3& x) const;
  /// Where the material that is at x was at the time of these places (m, one per vertex).
  /// @param x on the surface, hardly farther from the vertex than its neighbours are
  Vec3 place_at(const Vec3& x, const std::vector<Vec3>& places) const;

 private:
  using Coefficients = std::array<double, 5>;  // of u, v, u^2, uv and v^2
  struct Neighbor {
    int vertex;
    Vec3 offset;         // from the vertex of the chart (m)
    Coefficients share;  // of its value in each coefficient
  };
  void gather(const MeshAdjacency& adjacency, const std::vector<Vec3>& places);
  void solve_shares();
  /// The share of a neighbour's value in the polynomial at an offset.
  double share_at(const Neighbor& neighbor, const Vec3& offset) const;

  int vertex_;
  const std::vector<Vec3>& positions_;
  std::vector<Neighbor> neighbors_;  // none where they are too few: then the material of the vertex is the best guess
  Vec3 normal_, u_axis_, v_axis_;
  double radius_ = 0;  // m, unit of u and v
};

/// The vertex to which a walk over the edges from `start` towards x comes: none of its neighbours is nearer.
int nearest_by_walk(const KnownSurface& surface, int start, const Vec3& x);

/// Vertices have slid along the surface, over the material that they carried: each takes its rest position, and its
/// place in every layer, from where it is now on the surface before.
/// @param before positions of the vertices to which the mesh's material belongs (m); on the same surface
/// @param adjacency of the mesh
void take_material_of_new_places(const std::vector<Vec3>& before, const MeshAdjacency& adjacency, SurfaceMesh& mesh);

}  // namespace flowskin::tracking
