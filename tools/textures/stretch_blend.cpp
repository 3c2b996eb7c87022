#include "tools/textures/stretch_blend.h"

#include <algorithm>
#include <cmath>

#include "tracking/mesh/mesh_measures.h"
#include "tracking/mesh/texture_stretch.h"

namespace flowskin::tools {
namespace {

constexpr double kComplete = 1.5;  // limits at which the other texture shows alone
constexpr double kWorst = 3;       // limits; what a single triangle counts at most
constexpr int kSmoothings = 2;     // of the distortion, with the neighbours'
constexpr int kMostRings = 1000;   // of new vertices around known ones
constexpr double kUnknown = -1;

double area_of(const tracking::SurfaceMesh& mesh, const tracking::Triangle& triangle) {
  return doubled_area_vector(mesh.positions, triangle).norm() / 2;
}

/// Mean of each vertex and the corners of the triangles around it.
std::vector<double> averaged(const tracking::SurfaceMesh& mesh, const std::vector<double>& values) {
  std::vector<double> sums(values.size(), 0), counts(values.size(), 0);
  for (const tracking::Triangle& t : mesh.triangles) {
    const double mean = (values[t[0]] + values[t[1]] + values[t[2]]) / 3;
    for (const int vertex : t) {
      sums[vertex] += mean;
      ++counts[vertex];
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = counts[v] > 0 ? sums[v] / counts[v] : values[v];
  return sums;
}

}  // namespace

double blend_at(double distortion, double limit) {
  const double x = std::clamp(std::log(distortion / limit) / std::log(kComplete), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

std::vector<double> stretch_blend(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places, double limit) {
  const std::vector<tracking::Stretch> stretch = tracking::texture_stretch(mesh, places);
  std::vector<double> logarithms(mesh.positions.size(), 0), areas(mesh.positions.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double area = area_of(mesh, mesh.triangles[i]);
    const double logarithm = std::log(std::min(tracking::distortion(stretch[i]), kWorst * limit));
    for (const int vertex : mesh.triangles[i]) {
      logarithms[vertex] += area * logarithm;
      areas[vertex] += area;
    }
  }
  for (std::size_t v = 0; v < areas.size(); ++v) logarithms[v] = areas[v] > 0 ? logarithms[v] / areas[v] : 0;
  for (int pass = 0; pass < kSmoothings; ++pass) logarithms = averaged(mesh, logarithms);
  for (double& value : logarithms) value = blend_at(std::exp(value), limit);
  return logarithms;
}

double overstretched_share(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places, double limit,
                           const std::vector<double>& weights) {
  const std::vector<tracking::Stretch> stretch = tracking::texture_stretch(mesh, places);
  double beyond = 0, all = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const double area = area_of(mesh, mesh.triangles[i]);
    all += area;
    if (tracking::distortion(stretch[i]) > limit)
      beyond += area * (weights.empty() ? 1 : (weights[a] + weights[b] + weights[c]) / 3);
  }
  return all > 0 ? beyond / all : 0;
}

/// The last weight of each vertex; new ones take the mean of their neighbours', ring by ring.
std::vector<double> FollowingWeights::known_weights(const tracking::SurfaceMesh& mesh) const {
  std::vector<double> known(mesh.ids.size(), kUnknown);
  for (std::size_t v = 0; v < known.size(); ++v)
    if (const auto found = by_id_.find(mesh.ids[v]); found != by_id_.end()) known[v] = found->second;
  for (int ring = 0; ring < kMostRings; ++ring) {
    std::vector<double> sums(known.size(), 0), counts(known.size(), 0);
    for (const tracking::Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        for (const int other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
          if (known[t[k]] != kUnknown || known[other] == kUnknown) continue;
          sums[t[k]] += known[other];
          ++counts[t[k]];
        }
    bool found_any = false;
    for (std::size_t v = 0; v < known.size(); ++v) {
      if (counts[v] == 0) continue;
      known[v] = sums[v] / counts[v];
      found_any = true;
    }
    if (!found_any) break;
  }
  return known;
}

const std::vector<double>& FollowingWeights::follow(const tracking::SurfaceMesh& mesh,
                                                    const std::vector<double>& targets, double most) {
  weights_ = known_weights(mesh);
  by_id_.clear();
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    double& weight = weights_[v];
    weight = weight == kUnknown ? targets[v] : std::clamp(targets[v], weight - most, weight + most);
    by_id_[mesh.ids[v]] = weight;
  }
  return weights_;
}

void FollowingWeights::reset(const tracking::SurfaceMesh& mesh) {
  weights_.assign(mesh.ids.size(), 0);
  by_id_.clear();
  for (const std::uint64_t id : mesh.ids) by_id_[id] = 0;
}

}  // namespace flowskin::tools
