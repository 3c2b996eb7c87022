// Every length, share and angle that decides what is repaired, and how.
#pragma once

#include <array>
#include <numbers>

namespace flowskin::tracking {

/// Lengths are in cells: edge lengths, which is also the spacing of the grid that fresh surface is extracted on. The
/// table in docs/topology.md shows these numbers; a test holds the two together. "Measured on" names the scenes of
/// tests/surfaces where a limit much larger or smaller loses something.
struct RepairLimits {
  // What is looked at, and what is mended.

  /// A node on the wrong side of the mesh counts from this depth |f| / |grad f| on. Shallower: triangles cut corners.
  double wrong_side_depth = 0.3;
  /// Doubtful: mesh and field cross a grid edge farther apart. Measured on the rims of films of the stairs.
  double doubtful_crossing = 0.35;
  /// Doubtful: a vertex or triangle centre is farther from the surface of the grid's values. Measured on the stairs.
  double doubtful_distance = 0.25;
  /// Two surfaces farther apart than this are not the same. The acceptance tests allow 0.5.
  double too_far_apart = 0.47;
  /// A part or hole that only one surface has is looked for by distances, in this order: a thin neck is near its
  /// stumps.
  std::array<double, 3> stray_distances = {0.5, 0.3, 0.2};
  /// And by the angle that a part or hole leaves in a window (share of 4 pi), in this order.
  std::array<double, 3> hidden_angles = {0.75, 0.75, 0.4};
  /// Cells of that window to each side of its middle one.
  int hidden_window = 2;
  /// A triangle is narrow if its smallest angle is below (rad).
  double narrow_angle = 10 * std::numbers::pi / 180;
  /// Narrow triangles are replaced where they are this share of the triangles around them. Measured on drops that
  /// merge.
  double many_narrow = 0.01;
  /// Layers of cells around narrow triangles that are meant by that.
  int narrow_around = 2;
  /// Parts and holes of mesh and field are compared for parts of at least so much, one or the other (cubic cells): a
  /// part can enclose a little more than a cell in one surface and a little less in the other.
  std::array<double, 2> counted_parts = {0.5, 1};
  /// A component that encloses less is not worth its triangles (cubic cells).
  double dust = 0.05;
  /// A part that encloses less is compared by its true size, on the roots of the field (cubic cells).
  double compared_on_roots = 8;
  /// Layers of cells around a replaced region that are looked at again.
  int looked_at_again = 3;
  /// Times that a place may be marked in one call.
  int times_marked = 4;
  /// Rounds of looking and replacing in one call.
  int rounds = 14;

  // How a region is fitted in.

  /// Layers of cells by which the fresh surface overlaps the rest of the mesh.
  int margin = 3;
  /// A vertex of the border reaches the fresh surface within.
  double border_reach = 0.75;
  /// Cosine between the normals of one sheet at the border.
  double same_sheet = 0.5;
  /// Fresh surface within the border that is farther from the patch was missed by it.
  double missed = 0.47;
  /// Attempts to fit a region in, while it grows where it does not fit.
  int attempts = 30;
  /// Every so many attempts it grows all around.
  int all_around_every = 6;

  // How a patch is evened out.

  /// Evening out may carry the patch away from where marching cubes put it.
  double evened_within = 0.4;
  /// Attempts in which places that evening out has spoilt are frozen.
  int freezings = 5;
  /// An old vertex takes the place of a new one within.
  double same_vertex = 0.5;
  /// If it is so close to the fresh surface.
  double same_vertex_off_surface = 0.4;
  /// And their normals have this cosine.
  double same_vertex_normals = 0.7;
  /// And no triangle turns by more than the angle with this cosine.
  double same_vertex_turn = 0.5;
  /// And none gets a smaller angle than (rad).
  double same_vertex_angle = 20 * std::numbers::pi / 180;
  /// A new vertex goes on under the id of an old one that is gone within.
  double same_id = 1.0 / 3;
};

inline constexpr RepairLimits kRepairLimits;

}  // namespace flowskin::tracking
