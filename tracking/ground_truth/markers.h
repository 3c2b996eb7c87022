// Passive markers: points of the material that start on the surface and ride the flow, with no mesh and no method.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tracking/advection/particle_paths.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Velocity of the material at a place, at one time (m/s). Safe to call from many threads.
using Flow = std::function<Vec3(const Vec3&)>;
/// The flow at a time (s).
using FlowAt = std::function<Flow(double)>;

/// The particles' own flow, by moving least squares (local_flow).
Flow particle_flow(MetaballField field);
/// The same along the particles' paths. `paths` must outlive it.
FlowAt particle_flow(const ParticlePaths& paths, const FieldSettings& settings);

/// The arrays have one entry a marker.
struct Markers {
  double time = 0;                   ///< s
  std::vector<std::uint64_t> ids;    ///< Of the vertices on which they started; ascending.
  std::vector<Vec3> rest_positions;  ///< Of their material (m).
  std::vector<Vec3> positions;       ///< m
  std::vector<Vec3> normals;         ///< Of the surface nearby, outward; zero where unknown.
  std::vector<double> depths;        ///< |f| / |grad f| (m)
  std::vector<std::uint8_t> left;    ///< 1: left the surface, for good.

  int on_surface() const;  ///< How many have not left.

  template <class Archive>
  void visit(Archive& archive) {
    archive(time, ids, rest_positions, positions, normals, depths, left);
  }
};

/// Markers on the vertices of a mesh; where there are more than `most`, on every second, third, ... of them.
Markers start_markers(const SurfaceMesh& mesh, double time, int most);

/// Carries the markers to `time` by the classical Runge-Kutta method. Those that have left stay where they are.
void advect_markers(const FlowAt& flow_at, double time, int steps, Markers& markers);

/// Looks where the markers are on the surface now: markers farther than `most_depth` from it (m), in the fluid or out
/// of it, leave. Markers are not put back onto f = 0: they know the material only.
void settle_markers(const ImplicitField& field, double most_depth, Markers& markers);

}  // namespace flowskin::tracking
