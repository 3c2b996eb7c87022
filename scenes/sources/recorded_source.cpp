#include "scenes/sources/recorded_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/io/ply_reader.h"
#include "scenes/scene_checks.h"
#include "scenes/scene_file.h"
#include "scenes/sources/file_pattern.h"
#include "scenes/sources/forward_time.h"

namespace flowskin::scenes {
namespace {

/// A time this near to a file's (in frame intervals) is the file's: rounding of frame times must not interpolate.
constexpr double same_time = 1e-9;

bool has_column(const PlyFile& ply, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return ply.vertex.count(name) > 0; });
}

/// Calls visit(i, j) for all ids of two states in ascending order; -1 where the id is in the other one only.
template <class Visit>
void match_ids(const ParticleState& a, const ParticleState& b, Visit visit) {
  std::size_t i = 0, j = 0;
  while (i < a.ids.size() || j < b.ids.size()) {
    const bool in_a = i < a.ids.size() && (j >= b.ids.size() || a.ids[i] <= b.ids[j]);
    const bool in_b = j < b.ids.size() && (i >= a.ids.size() || b.ids[j] <= a.ids[i]);
    visit(in_a ? static_cast<std::ptrdiff_t>(i) : -1, in_b ? static_cast<std::ptrdiff_t>(j) : -1);
    i += in_a ? 1 : 0;
    j += in_b ? 1 : 0;
  }
}

void append(ParticleState& state, const ParticleState& from, std::size_t i, const Vec3& position, const Vec3& velocity,
            double density) {
  state.ids.push_back(from.ids[i]);
  state.positions.push_back(position);
  state.velocities.push_back(velocity);
  state.rest_positions.push_back(from.rest_positions[i]);
  state.densities.push_back(density);
}

/// The state at a share s of the interval from a to b.
ParticleState between(const ParticleState& a, const ParticleState& b, double s, double interval) {
  ParticleState state;
  const double s2 = s * s, s3 = s2 * s;
  match_ids(a, b, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    if (i >= 0 && j >= 0) {
      const Vec3 &x0 = a.positions[i], &x1 = b.positions[j];
      const Vec3 m0 = interval * a.velocities[i], m1 = interval * b.velocities[j];
      const Vec3 position =
          (2 * s3 - 3 * s2 + 1) * x0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * x1 + (s3 - s2) * m1;
      const Vec3 slope = (6 * s2 - 6 * s) * (x0 - x1) + (3 * s2 - 4 * s + 1) * m0 + (3 * s2 - 2 * s) * m1;
      append(state, a, i, position, slope / interval, (1 - s) * a.densities[i] + s * b.densities[j]);
    } else if (i >= 0 && s < 0.5) {
      append(state, a, i, a.positions[i] + s * interval * a.velocities[i], a.velocities[i], a.densities[i]);
    } else if (j >= 0 && i < 0 && s >= 0.5) {
      append(state, b, j, b.positions[j] + (s - 1) * interval * b.velocities[j], b.velocities[j], b.densities[j]);
    }
  });
  return state;
}

}  // namespace

RecordedSource::RecordedSource(const Scene& scene)
    : files_(files_of_pattern(absolute_name(scene.directory, scene.particles.recorded.files))),
      interval_(scene.particles.recorded.frame_interval),
      spacing_(scene.particles.spacing) {
  const PlyFile first = read_ply(files_.front());
  first_count_ = first.vertex_count;
  has_ids_ = has_column(first, {"id", "ids", "particle_id"});
  has_velocities_ = has_column(first, {"vx", "velocity_x", "velocity_0", "v_x"});
  has_rest_positions_ = has_column(first, {"rest_x", "rest_position_x"});
  advance_to(0);
}

bool RecordedSource::ends_before(double time) const {
  return time / interval_ > static_cast<double>(files_.size() - 1) + same_time;
}

void RecordedSource::advance_to(double time) {
  require_forward(state_.time, time);
  if (ends_before(time)) {
    throw SceneError(
        fmt::format("{}: the recorded sequence of {} files ends at {:.6g} s, before {:.6g} s; ask for fewer frames",
                    files_.back().string(), files_.size(), static_cast<double>(files_.size() - 1) * interval_, time));
  }
  const auto k = std::min(files_.size() - 1, static_cast<std::size_t>(time / interval_ + same_time));
  const double share = time / interval_ - static_cast<double>(k);
  const ParticleState here = complete_state(k);
  state_ = share <= same_time ? here : between(here, complete_state(k + 1), share, interval_);
  state_.time = time;
}

const ParticleState& RecordedSource::file_state(std::size_t k) {
  const auto found = cache_.find(k);
  if (found != cache_.end()) return found->second;
  // Rest positions are those of the first appearance, so no file may be left out on the way.
  const std::size_t next = cache_.empty() ? 0 : cache_.rbegin()->first + 1;
  for (std::size_t i = has_rest_positions_ ? std::max(next, k) : next; i <= k; ++i) {
    ParticleState state = particles_from_ply(files_[i]);
    if (!has_ids_ && state.ids.size() != first_count_) {
      throw SceneError(
          fmt::format("{}: {} particles where the first file has {}, and they have no ids (property \"id\") to "
                      "find them again by",
                      files_[i].string(), state.ids.size(), first_count_));
    }
    settle_rest_positions(state);
    cache_[i] = std::move(state);
    while (cache_.size() > 4) cache_.erase(cache_.begin());
  }
  return cache_.at(k);
}

void RecordedSource::settle_rest_positions(ParticleState& state) {
  if (has_rest_positions_) return;
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    state.rest_positions[i] = rest_positions_.emplace(state.ids[i], state.positions[i]).first->second;
  }
}

ParticleState RecordedSource::complete_state(std::size_t k) {
  if (has_velocities_) return file_state(k);
  // In ascending order, so that the files read last stay in the cache.
  const ParticleState before = k > 0 ? file_state(k - 1) : ParticleState{};
  ParticleState here = file_state(k);
  const ParticleState after = k + 1 < files_.size() ? file_state(k + 1) : ParticleState{};
  std::vector<double> span(here.ids.size(), 0.0);
  for (Vec3& velocity : here.velocities) velocity.setZero();
  const auto add_difference = [&](const ParticleState& other, double sign) {
    match_ids(here, other, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      if (i < 0 || j < 0) return;
      here.velocities[i] += sign * (other.positions[j] - here.positions[i]);
      span[i] += interval_;
    });
  };
  add_difference(before, -1);
  add_difference(after, 1);
  for (std::size_t i = 0; i < span.size(); ++i) {
    if (span[i] > 0) here.velocities[i] /= span[i];
  }
  return here;
}

SourceStatistics RecordedSource::statistics() const {
  SourceStatistics statistics;
  statistics.summary = fmt::format("recorded sequence: {} files from {}, one every {:.4g} s, {} particles in the first",
                                   files_.size(), files_.front().string(), interval_, first_count_);
  return statistics;
}

}  // namespace flowskin::scenes
