// Where a texture is stretched so far that another one should show.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// Share of another texture where this one is distorted so far: 0 up to the limit, 1 from one and a half times the
/// limit on, smooth between, over the logarithm of the distortion.
double blend_at(double distortion, double limit);

/// That share for each vertex. Its distortion is the geometric mean over the triangles around it, by their present
/// areas, averaged twice more with its neighbours' so that single bad triangles do not show.
/// @param places of the vertices' material (m), which the texture coordinates are a function of
std::vector<double> stretch_blend(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places, double limit);

/// Share of the surface's area where the texture of these places is distorted past the limit.
/// @param weights one per vertex: what counts of each triangle is their mean at its corners; empty: all
double overstretched_share(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places, double limit,
                           const std::vector<double>& weights = {});

/// Weights that follow others with limited speed, remembered by the ids of the vertices.
class FollowingWeights {
 public:
  /// Moves each weight towards its target, by `most` at most. New vertices begin with the mean of their neighbours';
  /// where none are known, at the target.
  const std::vector<double>& follow(const tracking::SurfaceMesh& mesh, const std::vector<double>& targets, double most);
  /// All are zero now.
  void reset(const tracking::SurfaceMesh& mesh);
  const std::vector<double>& weights() const { return weights_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(weights_, by_id_);
  }

 private:
  std::vector<double> known_weights(const tracking::SurfaceMesh& mesh) const;

  std::vector<double> weights_;  // of the vertices of the last call
  std::unordered_map<std::uint64_t, double> by_id_;
};

}  // namespace flowskin::tools
