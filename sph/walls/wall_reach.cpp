#include "sph/walls/wall_reach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/number_text.h"
#include "sph/geometry/clip.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

// In spacings: the longest lists, that of surface tension with the widest skin, reach 5, kernels of walls 4, and
// the volumes of wall particles depend on others as far again.
constexpr double reach_margin = 16;

// Twice the area of a convex polygon, and its longest edge.
struct Measure {
  double area2 = 0, longest = 0;
};

Measure measure(const std::vector<Vec3>& polygon) {
  Measure result;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    result.longest = std::max(result.longest, edge.norm());
    result.area2 += edge.cross(polygon[k] - polygon[0]).norm();
  }
  return result;
}

}  // namespace

Box wall_reach(const SolverSettings& settings) {
  const Box& domain = settings.domain;
  Box reach = everywhere();
  for (int a = 0; a < 3; ++a) {
    if (domain.min[a] == domain.max[a] || settings.periodic[a]) continue;
    reach.min[a] = domain.min[a] - reach_margin * settings.spacing;
    reach.max[a] = domain.max[a] + reach_margin * settings.spacing;
  }
  return reach;
}

double estimated_samples(const TriangleMesh& mesh, double spacing, const Box& reach) {
  double count = 0;
  for (const auto& t : mesh.triangles) {
    const Measure part = measure(clip({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, reach));
    count += std::max(0.5 * part.area2 / (spacing * spacing), std::floor(part.longest / spacing));
  }
  return count;
}

void WallCount::add(const TriangleMesh& mesh, const Box& reach, const std::string& name) {
  const double own = estimated_samples(mesh, sample_spacing_, reach);
  count_ += own;
  if (count_ <= kMostWallParticles) return;
  const bool bounded = reach.min.allFinite() && reach.max.allFinite();
  throw SettingsError(name + " takes about " + number_text(own, 4) + " wall particles at a spacing of " +
                      number_text(spacing_, 4) + " m (they lie " + number_text(sample_spacing_, 4) +
                      " m apart); all walls together may take " + number_text(kMostWallParticles, 4) +
                      ". Make the spacing larger or the mesh smaller (does a vertex stray?), or " +
                      (bounded ? "simulation.domain smaller: walls that rest count only in and near it"
                               : "give simulation.domain: walls that rest count only in and near it"));
}

}  // namespace flowskin::sph
