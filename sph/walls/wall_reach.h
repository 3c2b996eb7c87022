// Where walls matter, and how many particles they take there.
#pragma once

#include <string>

#include "sph/geometry/triangle_mesh.h"
#include "sph/setup/settings.h"

namespace flowskin::sph {

/// All walls of a set-up together: more are a slip of the spacing or of a mesh's unit.
inline constexpr double kMostWallParticles = 1e7;

/// Where walls that rest are sampled: in the domain and so far around it that fluid inside feels no end of them;
/// everywhere along axes without domain.
Box wall_reach(const SolverSettings& settings);

/// How many samples the part of a surface in the box takes, about. Costs no memory, however large the surface is.
double estimated_samples(const TriangleMesh& mesh, double spacing, const Box& reach);

/// Counts the samples of walls before they are made.
class WallCount {
 public:
  /// @param spacing of the fluid (m) @param sample_spacing distance of the samples (m)
  WallCount(double spacing, double sample_spacing) : spacing_(spacing), sample_spacing_(sample_spacing) {}
  /// @throws SettingsError with the number and what to do, where all walls until now take too many.
  void add(const TriangleMesh& mesh, const Box& reach, const std::string& name);

 private:
  double spacing_, sample_spacing_, count_ = 0;
};

}  // namespace flowskin::sph
