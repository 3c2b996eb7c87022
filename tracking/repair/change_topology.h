// Lets the topology of a mesh follow the field: regions where the two disagree are replaced. See docs/topology.md.
#pragma once

#include <string>
#include <vector>

#include "tracking/advection/projection.h"
#include "tracking/field/implicit_field.h"
#include "tracking/material/material.h"
#include "tracking/mesh/surface_mesh.h"
#include "tracking/particles.h"
#include "tracking/repair/small_parts.h"

namespace flowskin::tracking {

struct TopologySettings {
  double edge_length = 0;  ///< Of fresh surface, and the spacing of the grid on which mesh and field are compared (m).
  double depth = 0;        ///< Disagreements less deep than this are let pass (m).
  bool local = true;       ///< Replace the regions; false: only count them, as stubborn.
  double smallest_part = 0;                   ///< Components that enclose less, as fluid or as air (m^3), are small.
  SmallParts small_parts = SmallParts::keep;  ///< What becomes of them.
  MaterialSettings material;
};

/// What tells surfaces of different topology apart; parts that are dropped because they are small do not count.
struct SurfaceCounts {
  struct Parts {
    int components = 0;
    int euler = 0;  ///< Euler characteristic.
    bool operator==(const Parts&) const = default;
  };
  Parts of_half_a_cell, of_a_cell;  ///< Those that enclose so much or more.

  /// What is below a cell need not be in both; and a part can enclose a little more than a cell in one surface and a
  /// little less in the other.
  bool agree_with(const SurfaceCounts& other) const {
    return of_half_a_cell == other.of_half_a_cell || of_a_cell == other.of_a_cell;
  }
};

/// What was done.
struct TopologyReport {
  int regions = 0;         ///< Replaced.
  int stubborn = 0;        ///< Regions that could not be replaced.
  std::string why;         ///< Why the last of those could not be.
  int born = 0;            ///< Vertices with new ids.
  int dropped = 0;         ///< Components that were taken out because they are small.
  int balls = 0;           ///< Components that were made balls.
  SurfaceCounts counts;    ///< Of the mesh, in the end.
  SurfaceCounts expected;  ///< Of a fresh extraction.
  bool changed() const { return regions > 0 || dropped > 0; }
};

/// Replaces the regions of a mesh where it and the sign of the field disagree (Wojtan et al. 2009; for SPH Yu et al.
/// 2012), where triangles intersect, have no area or look inwards, and where vertices could not be put onto the
/// surface. Vertices outside keep position, id and all attributes, and their order. New ones take their material as
/// MaterialCarrier says; one that is beside an old one that is gone (same_vertices) its id, all others new ids. In the
/// end the mesh has as many parts and holes as a fresh extraction; where features are smaller than a cell they may
/// differ, and `counts` and `expected` tell.
/// @param projection of the mesh's vertices; brought up to date
TopologyReport change_topology(const ImplicitField& field, const Particles& particles, const TopologySettings& settings,
                               SurfaceMesh& mesh, Projection& projection);

}  // namespace flowskin::tracking
