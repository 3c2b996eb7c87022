// A fresh mesh of the field's surface.
#pragma once

#include "tracking/extraction/marching_cubes.h"
#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {

/// Marching cubes on the field's grid of spacing `edge_length` (m), vertices on f = 0 but triangles of any shape:
/// quick, for measuring. Empty where the field has no surface.
SurfaceGeometry extract_raw_surface(const ImplicitField& field, double edge_length);

/// Makes the triangles of a raw surface fit for tracking, with edges around `edge_length` (m) long: short edges are
/// collapsed, edges flipped towards Delaunay, vertices evened out along the surface. The topology of the surface is
/// kept; a component whose volume would change by more than 5 % keeps its raw triangles. Every vertex ends on the
/// surface as default_projection says, or stays where marching cubes put it.
SurfaceGeometry improve_surface(const ImplicitField& field, double edge_length, const SurfaceGeometry& surface);

/// Both.
SurfaceGeometry extract_surface(const ImplicitField& field, double edge_length);

}  // namespace flowskin::tracking
