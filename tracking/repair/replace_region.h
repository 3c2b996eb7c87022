// Replaces a region of a mesh by a fresh triangulation of the field's surface. See docs/topology.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/triangle_tree.h"
#include "tracking/extraction/cell_set.h"
#include "tracking/field/implicit_field.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/repair/triangle_bins.h"

namespace flowskin::tracking {

/// A change of a mesh: some triangles go, others come. Vertices that no triangle uses any more go with them.
struct MeshPatch {
  std::vector<int> removed;         ///< Triangles, ascending.
  std::vector<Vec3> born;           ///< New vertices, on the surface (m); numbered after those of the mesh.
  std::vector<Vec3> born_normals;   ///< Outward.
  std::vector<Triangle> triangles;  ///< New ones, of old and new vertices.
};

/// What is known of the field on a grid.
struct FieldGrid {
  const ImplicitField& field;
  const SparseGrid& grid;  ///< Its values; the spacing is the wanted edge length.
};

/// The box around a triangle, in grid coordinates.
Box box_of(const SparseGrid& grid, const Triangle& triangle, const std::vector<Vec3>& positions);

/// Of all triangles.
std::vector<Box> boxes_of(const SparseGrid& grid, const SurfaceMesh& mesh);

/// A mesh in which regions are being replaced.
struct MeshToMend {
  std::vector<Vec3> positions;  ///< m
  std::vector<Vec3> normals;    ///< Of the field, outward; one per vertex.
  std::vector<Triangle> triangles;
  std::vector<Box> boxes;   ///< One per triangle.
  std::vector<char> alive;  ///< One per triangle; 0: removed.
  TriangleBins bins;        ///< The triangles, removed ones too.
};

/// Why a region cannot be replaced as it is.
struct Misfit {
  std::string why;
  std::vector<CellSet::Cell> cells;  ///< Where it does not fit; none: somewhere.
};

/// Cuts the triangles that meet `cells` out of a mesh, together with those whose absence would leave the border
/// pinched; marching cubes fills the hole within the same cells, and the two are stitched along the border of the hole:
/// its vertices are inserted into the fresh surface, its edges made there by flips, and what lies beyond them is cut
/// off. New vertices are then evened out as far as no triangles intersect because of it. Vertices and triangles of the
/// mesh outside the hole stay as they are, but for edges at the border of the hole, which may be flipped.
/// @param misfit where the two surfaces do not fit together at the border, or where triangles of the patch intersect
/// others even though they are not evened out; then more cells there may help. Empty where all is well.
/// @return nothing where they do not fit together; a patch that intersects something is returned.
std::optional<MeshPatch> replace_region(const FieldGrid& fresh, const CellSet& cells, const MeshToMend& mesh,
                                        Misfit& misfit);

}  // namespace flowskin::tracking
