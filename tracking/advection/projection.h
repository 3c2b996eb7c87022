// Puts vertices onto the surface [FMM13, Eq. 12].
#pragma once

#include <vector>

#include "tracking/field/implicit_field.h"
#include "tracking/field/neighborhoods.h"

namespace flowskin::tracking {

struct ProjectionSettings {
  double tolerance = 0;     ///< A point is on the surface where |f| / |grad f| is at most this (m).
  double max_step = 0;      ///< Longest step of one iteration (m).
  double max_distance = 0;  ///< A point that would have to go farther than this is given up (m).
  int max_iterations = 30;
};

/// tolerance 1e-7, max_step 0.25, max_distance 1 lengths of the scale.
ProjectionSettings default_projection(const FieldScale& scale);

/// Where a projection ended.
struct SurfaceDistance {
  Vec3 normal = Vec3::Zero();  ///< -grad f / |grad f| at the point, outward; zero where the field is silent.
  double distance = 0;         ///< |f| / |grad f| (m); infinite where the field is silent.
};

/// |f| / |grad f| and the normal at a point.
SurfaceDistance surface_distance(const ImplicitField& field, const Vec3& x);
SurfaceDistance surface_distance(const LocalField& field, const Vec3& x);
/// The largest |f| / |grad f| at these points (m); 0 where there are none.
double largest_distance(const ImplicitField& field, const std::vector<Vec3>& points);

/// Newton's iteration x - f grad f / |grad f|^2 with limited steps, halved while they do not bring |f| down. Where it
/// fails (silent field, no progress, too far) x is left at its start.
/// @return false where it failed; `point` describes the place where x is in the end.
bool project_point(const ImplicitField& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point);
bool project_point(const LocalField& field, const ProjectionSettings& settings, Vec3& x, SurfaceDistance& point);

/// How far around its start a vertex that is moved along the surface usually stays (m): a slack for Neighborhoods.
double usual_slack(const FieldScale& scale);

/// What became of all vertices.
struct Projection {
  std::vector<Vec3> normals;      ///< Outward, one per vertex.
  std::vector<double> distances;  ///< |f| / |grad f| (m), one per vertex.
  std::vector<int> failed;        ///< Vertices that are not on the surface, ascending.
  double max_distance = 0;        ///< The largest of the distances (m).
};

/// project_point for every vertex.
Projection project_to_surface(const ImplicitField& field, const ProjectionSettings& settings,
                              std::vector<Vec3>& positions);
/// The same with the neighbourhoods of the positions, or of places near them; best with the usual slack.
Projection project_to_surface(const Neighborhoods& neighborhoods, const ProjectionSettings& settings,
                              std::vector<Vec3>& positions);

/// Brings a projection up to date where only some vertices have moved since.
/// @param moved the numbers of all vertices that have moved or failed
void project_moved(const ImplicitField& field, const ProjectionSettings& settings, const std::vector<int>& moved,
                   std::vector<Vec3>& positions, Projection& projection);

}  // namespace flowskin::tracking
