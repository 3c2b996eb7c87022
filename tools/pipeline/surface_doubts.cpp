#include "tools/pipeline/surface_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/sources/particle_spacing.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools {

namespace {

constexpr double kLeastVolume = 0.5, kMostVolume = 2;  // of the particles'
constexpr std::size_t kParticlesPerPiece = 100;
constexpr std::uint64_t kFewParticles = 10;  // have no surface
constexpr double kWideApart = 1.4;           // spacings, beyond which the surface has holes or is none

const char* const kRemedy = "--spacing (particles.spacing) sets the spacing, --radius (tracking.radius) the smoothing";

}  // namespace

std::vector<std::string> surface_doubts(const tracking::SurfaceMesh& mesh, std::size_t particles, double spacing) {
  std::vector<std::string> doubts;
  if (mesh.triangles.empty()) return doubts;
  const double volume = tracking::mesh_volume(mesh.positions, mesh.triangles);
  const double expected = static_cast<double>(particles) * std::pow(spacing, 3);
  if (volume < kLeastVolume * expected || volume > kMostVolume * expected)
    doubts.push_back(
        fmt::format("the first surface holds {:.4g} m^3, which is {:.2g} times the volume of the particles ({} of "
                    "spacing {:.4g} m): "
                    "is the spacing right? {}",
                    volume, volume / expected, particles, spacing, kRemedy));
  const auto pieces = static_cast<std::size_t>(tracking::mesh_components(mesh.positions, mesh.triangles).count);
  if (pieces > std::max<std::size_t>(1, particles / kParticlesPerPiece))
    doubts.push_back(fmt::format(
        "the first surface falls into {} pieces, for {} particles: is the spacing of {:.4g} m too small? {}", pieces,
        particles, spacing, kRemedy));
  return doubts;
}

std::string empty_frames(const std::vector<FrameRow>& rows) {
  const auto is_empty = [](const FrameRow& row) { return row.vertices == 0; };
  const auto first = std::find_if(rows.begin(), rows.end(), is_empty);
  if (first == rows.end()) return "";
  return fmt::format("{} of {} frames have no surface, the first is frame {}",
                     std::count_if(rows.begin(), rows.end(), is_empty), rows.size(), first->frame);
}

std::string why_no_surface(const std::vector<FrameRow>& rows, const std::vector<Vec3>& positions, double spacing) {
  std::uint64_t most = 0;
  for (const FrameRow& row : rows) most = std::max(most, row.particles);
  if (most == 0) return "there are no particles in any frame";
  if (most < kFewParticles)
    return fmt::format("there are {} particles at most: fewer than about ten have no surface", most);
  const scenes::SpacingEstimate estimate = scenes::estimate_spacing(positions);
  if (estimate.coincident > positions.size() / 2)
    return fmt::format("{} of {} particles are in places that others have, too", estimate.coincident, positions.size());
  if (estimate.dimensions < 3)
    return fmt::format(
        "all particles lie in a {}: these are data in {} dimension{}, and one layer has no surface. Repeat the "
        "particles "
        "in several layers, a spacing apart",
        estimate.dimensions == 2 ? "plane" : "line", estimate.dimensions, estimate.dimensions == 2 ? "s" : "");
  if (estimate.spacing > kWideApart * spacing)
    return fmt::format("the spacing of {:.4g} m is too small: the particles are {:.4g} m apart; {}", spacing,
                       estimate.spacing, kRemedy);
  return fmt::format(
      "the fluid is thinner than two spacings of {:.4g} m everywhere, or the particles are farther apart; {}", spacing,
      kRemedy);
}

}  // namespace flowskin::tools
