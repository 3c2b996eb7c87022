// What becomes of the texture where it is stretched past the scene's limit: docs/texture.md.
#pragma once

#include <unordered_map>
#include <vector>

#include "tools/textures/stretch_blend.h"
#include "tools/textures/texture_mapping.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// When one generation of the texture gives way to the next.
struct FadeSettings {
  double time = 0.5;          ///< s, at least, that a texture takes to fade into another.
  double begin_share = 0.05;  ///< Of the area past the limit: a newer generation begins.
  /// Of the area past the limit in spite of it: the newer one takes over everywhere, and the next may begin.
  double end_share = 0.10;
};

/// Keeps the textures of a tracked surface fit to be seen. A generation of the texture is fixed to the places that the
/// material had at one moment. The first are the rest positions; with "fade" a newer one begins where too much of the
/// surface is stretched, and shows where the older is stretched. Once too much is stretched in spite of it, it takes
/// over everywhere, and becomes the older one in a frame in which only it shows: nothing jumps.
class TextureGenerations {
 public:
  TextureGenerations(const scenes::TextureSpec& texture, const RestFrame& rest, const FadeSettings& fading = {});

  /// Tells particles their places in the generations, before they are given to the tracker. Particles that came later
  /// continue their first motion backwards. Those without lasting ids stay without. Particles that are not among these
  /// are forgotten: one that comes back counts as new.
  void carry(tracking::Particles& particles);

  /// Moves on by `duration` (s) to the present mesh of the tracker, whose layers are the generations but the first.
  /// @param particles the tracker's
  void update(tracking::Tracker& tracker, const tracking::Particles& particles, double duration);

  /// Coordinates of the older generation, of the newer one, and the share of the newer or of the solid texture.
  /// @param mesh the tracker's at the last update
  SurfaceFrame dress(const tracking::SurfaceMesh& mesh, double time) const;

  /// Share of the surface's area where the texture is stretched past the limit, each generation counted by its weight;
  /// the solid texture counts as not stretched.
  double overstretched() const { return overstretched_; }
  /// Whether the mesh has the layers of these generations.
  bool fit(const tracking::SurfaceMesh& mesh) const {
    return layers_.size() == mesh.layers.size() && (older_is_rest_ || !layers_.empty());
  }
  /// How many generations there have been.
  int generations() const { return generations_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive.section("textures");
    archive(layers_, older_is_rest_, taking_over_, weights_, overstretched_, generations_);
  }

 private:
  /// A generation but the first: where the material was when it began.
  struct Layer {
    double time = 0;  // s
    bool known = false;
    std::unordered_map<std::uint64_t, Vec3> places;  // by the particles' ids
    RestFrame frame;

    template <class Archive>
    void visit(Archive& archive) {
      archive(time, known, places, frame);
    }
  };

  /// Returns the overstretched share, once the newer generation shows as far as it should.
  double fade(tracking::Tracker& tracker, const tracking::Particles& particles, double most);
  void begin(tracking::Tracker& tracker, const tracking::Particles& particles);
  void promote(tracking::Tracker& tracker);
  bool has_newer() const { return layers_.size() > (older_is_rest_ ? 0U : 1U); }
  const std::vector<Vec3>& older(const tracking::SurfaceMesh& mesh) const {
    return older_is_rest_ ? mesh.rest_positions : mesh.layers.front();
  }
  double measure(const tracking::SurfaceMesh& mesh) const;

  scenes::TextureSpec texture_;
  RestFrame rest_;
  FadeSettings fading_;
  std::vector<Layer> layers_;  // in the order of the mesh's
  bool older_is_rest_ = true, taking_over_ = false;
  FollowingWeights weights_;
  double overstretched_ = 0;
  int generations_ = 1;
};

}  // namespace flowskin::tools
