#include "tools/textures/texture_generations.h"

#include <algorithm>
#include <unordered_set>

namespace flowskin::tools {
namespace {

bool all_one(const std::vector<double>& weights) {
  return std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 1; });
}

std::vector<double> one_minus(std::vector<double> weights) {
  for (double& weight : weights) weight = 1 - weight;
  return weights;
}

/// Drops the entries of ids that are not among these, all of which have one: particles that were drained or left.
void forget_others(const std::vector<std::uint64_t>& ids, std::unordered_map<std::uint64_t, Vec3>& places) {
  if (places.size() == ids.size()) return;
  const std::unordered_set<std::uint64_t> present(ids.begin(), ids.end());
  std::erase_if(places, [&](const auto& entry) { return !present.contains(entry.first); });
}

}  // namespace

TextureGenerations::TextureGenerations(const scenes::TextureSpec& texture, const RestFrame& rest,
                                       const FadeSettings& fading)
    : texture_(texture), rest_(rest), fading_(fading) {}

void TextureGenerations::carry(tracking::Particles& particles) {
  particles.layers.assign(layers_.size(), {});
  if (!particles.has_lasting_ids || !particles.weights.empty()) return;
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    Layer& layer = layers_[k];
    if (!layer.known) continue;
    for (std::size_t i = 0; i < particles.ids.size(); ++i) {
      const auto [place, is_new] = layer.places.try_emplace(particles.ids[i], particles.positions[i]);
      if (is_new && !particles.velocities.empty())
        place->second -= (particles.time - layer.time) * particles.velocities[i];
      particles.layers[k].push_back(place->second);
    }
    forget_others(particles.ids, layer.places);
  }
}

void TextureGenerations::update(tracking::Tracker& tracker, const tracking::Particles& particles, double duration) {
  const double most = duration / fading_.time;
  const tracking::SurfaceMesh& mesh = tracker.mesh();
  if (texture_.when_stretched == "fade") {
    overstretched_ = fade(tracker, particles, most);
    return;
  }
  if (texture_.when_stretched == "solid")
    weights_.follow(mesh, stretch_blend(mesh, mesh.rest_positions, texture_.stretch_limit), most);
  overstretched_ = measure(mesh);
}

double TextureGenerations::fade(tracking::Tracker& tracker, const tracking::Particles& particles, double most) {
  const tracking::SurfaceMesh& mesh = tracker.mesh();
  if (!has_newer()) {
    weights_.reset(mesh);
    const double share = measure(mesh);
    if (share > fading_.begin_share) begin(tracker, particles);
    return share;  // the newer one does not show yet
  }
  const std::vector<double> targets = taking_over_ ? std::vector<double>(mesh.ids.size(), 1.0)
                                                   : stretch_blend(mesh, older(mesh), texture_.stretch_limit);
  weights_.follow(mesh, targets, most);
  const double share = measure(mesh);
  if (share > fading_.end_share) taking_over_ = true;
  if (taking_over_ && all_one(weights_.weights())) promote(tracker);
  return share;  // what shows stays the same
}

void TextureGenerations::begin(tracking::Tracker& tracker, const tracking::Particles& particles) {
  tracker.begin_layer();
  Layer& layer = layers_.emplace_back();
  layer.time = particles.time;
  layer.known = particles.has_lasting_ids && particles.weights.empty();
  for (std::size_t i = 0; i < particles.ids.size() && layer.known; ++i)
    layer.places.emplace(particles.ids[i], particles.positions[i]);
  layer.frame = rest_frame(tracker.mesh().positions);
  layer.frame.size = rest_.size;  // so that the tiles stay as large as they are
  ++generations_;
}

/// In a frame in which only the newer generation shows.
void TextureGenerations::promote(tracking::Tracker& tracker) {
  if (!older_is_rest_) {
    tracker.drop_layer(0);
    layers_.erase(layers_.begin());
  }
  older_is_rest_ = false;
  taking_over_ = false;
  weights_.reset(tracker.mesh());
}

double TextureGenerations::measure(const tracking::SurfaceMesh& mesh) const {
  const double limit = texture_.stretch_limit;
  if (texture_.when_stretched == "leave") return overstretched_share(mesh, mesh.rest_positions, limit);
  double share = overstretched_share(mesh, older(mesh), limit, one_minus(weights_.weights()));
  if (has_newer()) share += overstretched_share(mesh, mesh.layers.back(), limit, weights_.weights());
  return share;
}

SurfaceFrame TextureGenerations::dress(const tracking::SurfaceMesh& mesh, double time) const {
  SurfaceFrame frame = tools::dress(mesh, time, texture_, rest_);
  if (texture_.when_stretched == "leave") return frame;
  frame.texture_blend.assign(weights_.weights().begin(), weights_.weights().end());
  if (texture_.when_stretched != "fade") return frame;
  if (!older_is_rest_) {
    frame.vertex_uvs = vertex_uvs(mesh, mesh.layers.front(), texture_, layers_.front().frame);
    frame.corner_uvs = corner_uvs(mesh, mesh.layers.front(), texture_, layers_.front().frame);
  }
  if (!has_newer()) {
    frame.vertex_uvs2 = frame.vertex_uvs;
    frame.corner_uvs2 = frame.corner_uvs;
    return frame;
  }
  frame.vertex_uvs2 = vertex_uvs(mesh, mesh.layers.back(), texture_, layers_.back().frame);
  frame.corner_uvs2 = corner_uvs(mesh, mesh.layers.back(), texture_, layers_.back().frame);
  return frame;
}

}  // namespace flowskin::tools
