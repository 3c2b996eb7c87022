#include "scenes/sources/recorded_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "common/bounds.h"
#include "common/errors.h"
#include "common/outliers.h"
#include "scenes/sources/forward_time.h"
#include "scenes/sources/particle_spacing.h"
#include "scenes/sources/wall_points.h"
#include "tracking/advection/jumps.h"
#include "tracking/advection/match_ids.h"
#include "tracking/mesh/point_tree.h"

namespace flowskin::scenes {
namespace {

using tracking::match_ids;

/// A time this near to a file's (in frame intervals) is the file's: rounding of frame times must not interpolate.
constexpr double same_time = 1e-9;
/// Files at hand.
constexpr std::size_t most_cached = 5;

void append(ParticleState& state, const ParticleState& from, std::size_t i, const Vec3& position, const Vec3& velocity,
            double density) {
  state.ids.push_back(from.ids[i]);
  state.positions.push_back(position);
  state.velocities.push_back(velocity);
  state.rest_positions.push_back(from.rest_positions[i]);
  state.densities.push_back(density);
}

/// Which of the particles that are in both states, in ascending order of their ids, have jumped; empty: none.
std::vector<char> jumps_between(const ParticleState& a, const ParticleState& b, double interval, bool with_velocities,
                                double spacing) {
  std::vector<tracking::Sighting> both;
  match_ids(a.ids, b.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    if (i < 0 || j < 0) return;
    both.push_back({b.positions[j] - a.positions[i]});
    if (!with_velocities) return;
    both.back().before = a.velocities[i];
    both.back().after = b.velocities[j];
  });
  return tracking::jumped(both, interval, with_velocities, spacing);
}

/// Calls visit(i, j) as match_ids does, where a particle that has jumped is one of each state.
template <class Visit>
void match_particles(const ParticleState& a, const ParticleState& b, const std::vector<char>& jumps, Visit visit) {
  std::size_t k = 0;
  match_ids(a.ids, b.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    const bool same = i < 0 || j < 0 || jumps.empty() || !jumps[k];
    if (i >= 0 && j >= 0) ++k;
    if (same) return visit(i, j);
    visit(i, -1);
    visit(-1, j);
  });
}

/// The state at a share s of the interval from a to b. Ids stay in ascending order.
ParticleState between(const ParticleState& a, const ParticleState& b, double s, double interval, double spacing) {
  ParticleState state;
  const double s2 = s * s, s3 = s2 * s;
  match_particles(a, b, jumps_between(a, b, interval, true, spacing), [&](std::ptrdiff_t i, std::ptrdiff_t j) {
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

/// @throws InputError where the velocities carry particles absurdly far until the next file: the interpolated ones
/// would be anywhere.
void check_speeds(const ParticleSequence& sequence, double spacing) {
  constexpr double farthest = 1e5;  // spacings
  if (!sequence.first.has_velocities || sequence.places.size() < 2) return;
  double fastest = 0;
  for (const Vec3& v : sequence.first.state.velocities) fastest = std::max(fastest, v.norm());
  if (fastest * sequence.interval <= farthest * spacing) return;
  throw InputError(fmt::format(
      "{}: at {:.4g} m/s a particle goes {:.4g} m until the next file, {:.4g} s later, which is more than "
      "{:g} spacings of {:.4g} m; are velocities, times (--time-step) and spacing right?",
      sequence.places.front().name(), fastest, fastest * sequence.interval, sequence.interval, farthest, spacing));
}

/// Where particles, found again by their ids, go clearly farther or less far from file to file than their velocities
/// say: by what factor. The first two files with motion count. Empty: all is well, or nothing can be told.
std::string contradicting_velocities(const ParticleSequence& sequence, double spacing) {
  constexpr double least_factor = 1 / 1.5, most_factor = 1.5;
  constexpr double least_path = 0.02;  // spacings, by either
  constexpr std::size_t most_looks = 4, fewest = 8;
  if (!sequence.first.has_velocities || sequence.ids == ParticleSequence::Ids::none) return {};
  const std::size_t count = sequence.places.size();
  for (std::size_t look = 0; look < most_looks && count >= 2; ++look) {
    const std::size_t k = look * (count - 2) / (most_looks - 1);
    ParticleState a = read_sequence_file(sequence, k).state, b = read_sequence_file(sequence, k + 1).state;
    if (sequence.ids == ParticleSequence::Ids::order) {
      std::iota(a.ids.begin(), a.ids.end(), 0);
      std::iota(b.ids.begin(), b.ids.end(), 0);
    }
    const double interval = sequence.times[k + 1] - sequence.times[k];
    std::vector<double> factors;
    match_ids(a.ids, b.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      if (i < 0 || j < 0) return;
      const Vec3 path = b.positions[j] - a.positions[i], told = interval / 2 * (a.velocities[i] + b.velocities[j]);
      if (std::max(path.norm(), told.norm()) < least_path * spacing) return;
      factors.push_back(told.isZero(0) ? HUGE_VAL : path.dot(told) / told.squaredNorm());
    });
    if (factors.size() < std::max(fewest, a.ids.size() / 4)) continue;
    const double factor = quantile(factors, 0.5);
    if (factor >= least_factor && factor <= most_factor) return {};
    if (!(factor > 0 && std::isfinite(factor)))
      return fmt::format(
          "from {} to the next file the particles do not move as their velocities say: are the ids lasting, and the "
          "velocities right?",
          std::filesystem::path(sequence.places[k].name()).filename().string());
    return fmt::format(
        "from {} to the next file the particles go {:.3g} times as far as their velocities say: the frame rate "
        "(--time-step {:.4g} would fit) or the unit of the velocities seems wrong",
        std::filesystem::path(sequence.places[k].name()).filename().string(), factor, interval * factor);
  }
  return {};
}

/// The particles of both states, each moved by its velocity, weighted by how near the states are.
ParticleState blended(const ParticleState& a, const ParticleState& b, double s, double interval) {
  ParticleState state;
  const auto add = [&](const ParticleState& from, double weight, double duration) {
    for (std::size_t i = 0; i < from.ids.size(); ++i) {
      append(state, from, i, from.positions[i] + duration * from.velocities[i], from.velocities[i], from.densities[i]);
      state.ids.back() = state.weights.size();
      state.weights.push_back(weight);
    }
  };
  add(a, 1 - s, s * interval);
  state.earlier_count = state.ids.size();
  add(b, s, (s - 1) * interval);
  return state;
}

/// Leaves out particles so far from nearly all others that no grid reaches them. @return how many
std::size_t leave_out_strays(ParticleState& state, double spacing) {
  constexpr double farthest = 1e5;  // spacings from the box of nearly all
  const std::size_t count = state.ids.size();
  if (count == 0) return 0;
  const Box box = bounds(without_outliers(state.positions, farthest * spacing));
  const auto is_inside = [&](const Vec3& x) {
    return ((x - box.min).array() >= 0).all() && ((box.max - x).array() >= 0).all();
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_inside(state.positions[i])) continue;
    state.ids[kept] = state.ids[i];
    state.positions[kept] = state.positions[i];
    state.velocities[kept] = state.velocities[i];
    state.rest_positions[kept] = state.rest_positions[i];
    state.densities[kept++] = state.densities[i];
  }
  state.ids.resize(kept);
  state.positions.resize(kept);
  state.velocities.resize(kept);
  state.rest_positions.resize(kept);
  state.densities.resize(kept);
  return count - kept;
}

/// A particle's place in another file.
struct PlaceInFile {
  double time;  // from the file in question (s)
  Vec3 position;
};

/// Adds to `ids` those of the particles that jump from one file to the next, a time `interval` later or earlier.
void add_jumpers(const ParticleState& from, const ParticleState& to, double interval, double spacing,
                 std::vector<std::uint64_t>& ids) {
  match_particles(from, to, jumps_between(from, to, interval, false, spacing), [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    if (i >= 0 && j < 0) ids.push_back(from.ids[i]);
  });
  std::sort(ids.begin(), ids.end());
}

/// Adds where the particles are in another file, a time `time` away, but for some, whose ids ascend.
void add_places(const ParticleState& here, const ParticleState& other, double time,
                const std::vector<std::uint64_t>& but_for, std::vector<std::vector<PlaceInFile>>& places) {
  match_ids(here.ids, other.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    if (i >= 0 && j >= 0 && !std::binary_search(but_for.begin(), but_for.end(), here.ids[i]))
      places[i].push_back({time, other.positions[j]});
  });
}

/// Derivative at time 0 of the polynomial through a place at time 0 and up to two others.
Vec3 velocity_through(const Vec3& here, const std::vector<PlaceInFile>& others) {
  if (others.empty()) return Vec3::Zero();
  const double a = others[0].time;
  const Vec3 slope_a = (others[0].position - here) / a;
  if (others.size() == 1) return slope_a;
  const double b = others[1].time;
  const Vec3 slope_b = (others[1].position - here) / b;
  return (b * slope_a - a * slope_b) / (b - a);
}

/// Particles that no other file knows, or that have just jumped, move as the nearest one that is known moves.
void take_velocities_of_nearest(const std::vector<std::vector<PlaceInFile>>& places, ParticleState& state) {
  std::vector<Vec3> known, velocities;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].empty()) continue;
    known.push_back(state.positions[i]);
    velocities.push_back(state.velocities[i]);
  }
  if (known.empty() || known.size() == places.size()) return;
  const tracking::PointCloud cloud{known};
  const tracking::PointTree tree(3, cloud);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].empty()) continue;
    int nearest = 0;
    double squared = 0;
    tree.knnSearch(state.positions[i].data(), 1, &nearest, &squared);
    state.velocities[i] = velocities[nearest];
  }
}

}  // namespace

RecordedSource::RecordedSource(const Scene& scene)
    : sequence_(open_sequence(scene.particles.recorded, scene.directory)),
      spacing_(scene.particles.spacing),
      walls_(sample_walls(scene)) {
  check_speeds(sequence_, spacing_);
  if (const std::string warning = contradicting_velocities(sequence_, spacing_); !warning.empty())
    warnings_.push_back(warning);
  advance_to(0);
}

bool RecordedSource::ends_before(double time) const {
  return time > sequence_.times.back() + same_time * sequence_.interval;
}

void RecordedSource::advance_to(double time) {
  require_forward(state_.time, time);
  const std::vector<double>& times = sequence_.times;
  if (ends_before(time)) {
    throw InputError(
        fmt::format("{}: the recorded sequence of {} files ends at {:.6g} s, before {:.6g} s; ask for fewer frames",
                    sequence_.places.back().file.string(), times.size(), times.back(), time));
  }
  const double tolerance = same_time * sequence_.interval;
  const auto after = std::upper_bound(times.begin(), times.end(), time + tolerance);
  const auto k = static_cast<std::size_t>(after - times.begin()) - 1;
  const double elapsed = time - times[k];
  const ParticleState here = complete_state(k);
  if (elapsed <= tolerance) {
    state_ = here;
  } else {
    const double interval = times[k + 1] - times[k];
    const ParticleState next = complete_state(k + 1);
    state_ = has_lasting_ids() ? between(here, next, elapsed / interval, interval, spacing_)
                               : blended(here, next, elapsed / interval, interval);
  }
  state_.has_lasting_ids = has_lasting_ids();
  state_.has_velocities = has_lasting_ids() || sequence_.first.has_velocities;
  state_.has_material = has_lasting_ids() || sequence_.first.has_rest_positions;
  state_.time = time;
  state_.walls = walls_;
}

const ParticleState& RecordedSource::file_state(std::size_t k) {
  const auto found = cache_.find(k);
  if (found != cache_.end()) return found->second;
  // Rest positions are those of the first appearance, so no file may be left out on the way.
  const std::size_t next = cache_.empty() ? 0 : cache_.rbegin()->first + 1;
  const bool may_skip = sequence_.first.has_rest_positions || !has_lasting_ids();
  for (std::size_t i = may_skip ? std::max(next, k) : next; i <= k; ++i) {
    read_into_cache(i);
    while (cache_.size() > most_cached) cache_.erase(cache_.begin());
    std::erase_if(renewals_, [&](const Renewal& renewal) { return renewal.file < cache_.begin()->first; });
  }
  return cache_.at(k);
}

void RecordedSource::read_into_cache(std::size_t k) {
  ParticleFile file = read_sequence_file(sequence_, k);
  left_out_[k] = file.left_out;
  ParticleState state = std::move(file.state);
  if (sequence_.ids != ParticleSequence::Ids::of_files) std::iota(state.ids.begin(), state.ids.end(), 0);
  left_out_[k].stray += leave_out_strays(state, spacing_);
  settle_rest_positions(k, state);
  cache_[k] = std::move(state);
  if (!checksums_.contains(k)) checksums_[k] = checksum_of_place(sequence_.places[k], *sequence_.tables);
}

namespace {

/// What must be the same about a sequence to go on with it. More files may have come.
struct SequenceMark {
  std::vector<std::string> names;
  std::vector<std::uint64_t> sizes;  // bytes
  std::vector<double> times;
  int ids = 0;

  explicit SequenceMark(const ParticleSequence& sequence) : times(sequence.times), ids(static_cast<int>(sequence.ids)) {
    for (const FrameTables::Place& place : sequence.places) {
      names.push_back(std::filesystem::path(place.name()).filename().string());
      sizes.push_back(size_of_place(place, *sequence.tables));
    }
  }
  SequenceMark() = default;
  template <class Archive>
  void visit(Archive& archive) {
    archive(names, sizes, times, ids);
  }
};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(what + "; the run cannot be resumed with other particles: start it anew");
}

/// @throws InputError where the files are no longer those of the mark.
void check_same_files(const SequenceMark& then, const SequenceMark& now) {
  if (then.sizes.size() != then.names.size() || then.times.size() != then.names.size())
    throw StateError("the saved list of files contradicts itself");
  for (std::size_t k = 0; k < then.names.size(); ++k) {
    if (k >= now.names.size() || now.names[k] != then.names[k])
      refuse(fmt::format("{} is no longer among the recorded particles", then.names[k]));
    if (now.sizes[k] != then.sizes[k] || now.times[k] != then.times[k])
      refuse(fmt::format("{} has changed since the run that is to be resumed", then.names[k]));
  }
  if (then.ids != now.ids) refuse("whether the recorded particles have lasting ids has changed");
}

/// @throws InputError where a file that has been read holds something else now. Those to come may change: nothing has
/// come of them yet.
void check_same_content(const std::map<std::uint64_t, std::uint32_t>& checksums, const ParticleSequence& sequence) {
  for (const auto& [k, then] : checksums) {
    const FrameTables::Place& place = sequence.places.at(k);
    if (checksum_of_place(place, *sequence.tables) != then)
      refuse(fmt::format("what is in {} has changed since the run that is to be resumed",
                         std::filesystem::path(place.name()).filename().string()));
  }
}

}  // namespace

void RecordedSource::save(StateWriter& writer) const {
  std::vector<std::uint64_t> cached;
  for (const auto& entry : cache_) cached.push_back(entry.first);
  writer.section("recorded particles");
  writer(SequenceMark(sequence_), state_, rest_positions_, renewals_, cached, checksums_);
}

void RecordedSource::restore(StateReader& reader) {
  SequenceMark mark;
  std::vector<std::uint64_t> cached;
  reader.section("recorded particles");
  reader(mark, state_, rest_positions_, renewals_, cached, checksums_);
  check_restored(state_);
  check_same_files(mark, SequenceMark(sequence_));
  if (!checksums_.empty() && checksums_.rbegin()->first >= sequence_.places.size())
    throw StateError("the saved state names a file that is not there");
  check_same_content(checksums_, sequence_);
  if (cached.size() > most_cached ||
      std::adjacent_find(cached.begin(), cached.end(), std::greater_equal<>()) != cached.end())
    throw StateError("the saved list of files at hand contradicts itself");
  cache_.clear();
  take_back_renewals(cached);
  for (const std::uint64_t k : cached) {
    if (k >= sequence_.places.size()) throw StateError("the saved state names a file that is not there");
    read_into_cache(k);
  }
}

void RecordedSource::settle_rest_positions(std::size_t k, ParticleState& state) {
  if (sequence_.first.has_rest_positions || !has_lasting_ids()) return;
  const auto before = k > 0 ? cache_.find(k - 1) : cache_.end();
  if (before != cache_.end()) {
    const ParticleState& last = before->second;
    const double interval = sequence_.times[k] - sequence_.times[k - 1];
    const std::vector<char> jumps = jumps_between(last, state, interval, sequence_.first.has_velocities, spacing_);
    std::size_t both = 0;
    match_ids(last.ids, state.ids, [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      if (jumps.empty() || i < 0 || j < 0 || !jumps[both++]) return;
      Vec3& rest_position = rest_positions_[state.ids[j]];
      renewals_.push_back({k, state.ids[j], rest_position});
      rest_position = state.positions[j];
    });
  }
  for (std::size_t i = 0; i < state.ids.size(); ++i) {
    state.rest_positions[i] = rest_positions_.emplace(state.ids[i], state.positions[i]).first->second;
  }
}

void RecordedSource::take_back_renewals(const std::vector<std::uint64_t>& cached) {
  while (!cached.empty() && !renewals_.empty() && renewals_.back().file > cached.front()) {
    rest_positions_[renewals_.back().id] = renewals_.back().before;
    renewals_.pop_back();
  }
}

ParticleState RecordedSource::complete_state(std::size_t k) {
  if (sequence_.first.has_velocities || !has_lasting_ids()) return file_state(k);
  // The two files next to k, in ascending order, so that the files read last stay in the cache.
  const std::size_t count = sequence_.places.size();
  const std::size_t low = std::min(k > 0 ? k - 1 : 0, count > 3 ? count - 3 : 0), high = std::min(low + 2, count - 1);
  for (std::size_t i = low; i <= high; ++i) file_state(i);
  ParticleState here = file_state(k);
  std::vector<std::vector<PlaceInFile>> places(here.ids.size());
  // From file to file, as far as each particle goes without a jump: over several files many would have jumped.
  const std::vector<double>& times = sequence_.times;
  for (const int step : {-1, 1}) {
    std::vector<std::uint64_t> gone;
    for (std::size_t i = k; i != (step < 0 ? low : high); i += step) {
      add_jumpers(file_state(i), file_state(i + step), times[i + step] - times[i], spacing_, gone);
      add_places(here, file_state(i + step), times[i + step] - times[k], gone, places);
    }
  }
  for (std::size_t i = 0; i < here.ids.size(); ++i) here.velocities[i] = velocity_through(here.positions[i], places[i]);
  take_velocities_of_nearest(places, here);
  return here;
}

std::size_t RecordedSource::nearest_file() const {
  const std::vector<double>& times = sequence_.times;
  const auto after = std::upper_bound(times.begin(), times.end(), state_.time + same_time * sequence_.interval);
  return after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
}

SourceStatistics RecordedSource::statistics() const {
  using Ids = ParticleSequence::Ids;
  SourceStatistics statistics;
  statistics.summary = fmt::format(
      "recorded sequence: {} files from {}, one every {:.4g} s, {} particles in the first, {}, velocities {}",
      sequence_.places.size(), sequence_.places.front().file.string(), sequence_.interval,
      sequence_.first.state.positions.size(),
      sequence_.ids == Ids::of_files ? "ids as recorded"
      : sequence_.ids == Ids::order  ? "their order as ids"
                                     : "no ids: each two states are blended",
      sequence_.first.has_velocities ? "as recorded"
      : has_lasting_ids()            ? "from differences"
                                     : "unknown");
  const auto next = left_out_.upper_bound(nearest_file());
  if (next == left_out_.begin()) return statistics;
  const LeftOut& left_out = std::prev(next)->second;
  statistics.not_wanted = left_out.unwanted();
  statistics.skipped_invalid = left_out.invalid;
  statistics.skipped_duplicates = left_out.duplicate;
  if (left_out.all() > 0) statistics.summary += "; left out of the file at hand: " + left_out_text(left_out);
  return statistics;
}

}  // namespace flowskin::scenes
