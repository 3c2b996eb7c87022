// Particles on triangle surfaces.
#pragma once

#include <vector>

#include "sph/forces/kernels.h"
#include "sph/geometry/clip.h"
#include "sph/geometry/periodic_box.h"
#include "sph/geometry/triangle_mesh.h"

namespace flowskin::sph {

/// Samples a surface with points about `spacing` apart: corners and sharp or open edges first, then a square lattice in
/// each plane (neighbouring triangles of one plane share it), then what is still uncovered. Every point of the surface
/// has a sample within `coverage_radius` spacings. Same mesh, same samples.
/// @param periodic the mesh must lie inside (PeriodicBox::clip()). Samples on opposite faces count as one, and lattices
///        along the box are stretched a little, to fit its period.
/// @param reach only samples in this box are made, and only as much of the surface is walked over
std::vector<Vec3> sample_surface(const TriangleMesh& mesh, double spacing, const PeriodicBox& periodic = {},
                                 const Box& reach = everywhere());
inline constexpr double coverage_radius = 1.0;

/// Volume that a boundary particle stands for: V_b = 1 / sum_k W(x_b - x_k) over all boundary particles [AIA*12, Eq.
/// 4].
/// @return volumes in m^3, one for each position
std::vector<double> boundary_volumes(const std::vector<Vec3>& positions, KernelType kernel, double support_radius,
                                     const PeriodicBox& periodic = {});

}  // namespace flowskin::sph
