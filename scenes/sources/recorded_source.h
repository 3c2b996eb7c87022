// Particles of a recorded sequence of PLY files, whoever wrote it.
#pragma once

#include <filesystem>
#include <map>

#include "scenes/scene.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// File k is the state at k frame intervals. Between files every particle, found again by its id, follows the cubic
/// Hermite curve through its places and velocities; one that is in only one of the two files goes straight on for the
/// half of the interval next to that file. What the files do not tell is made up for: velocities from differences
/// (central where possible), rest positions from the first file that holds the particle, ids from the order in the
/// file where the number of particles never changes. All files have the columns of the first.
class RecordedSource : public ParticleSource {
 public:
  /// @throws SceneError naming the file and what is wrong with it or with the sequence.
  explicit RecordedSource(const Scene& scene);

  const ParticleState& state() const override { return state_; }
  /// @throws SceneError where a file cannot be read, or the sequence ends before `time`.
  void advance_to(double time) override;
  double spacing() const override { return spacing_; }
  SourceStatistics statistics() const override;
  bool ends_before(double time) const override;

 private:
  /// File k as it is, with rest positions; a few files are kept.
  const ParticleState& file_state(std::size_t k);
  /// File k with velocities.
  ParticleState complete_state(std::size_t k);
  void settle_rest_positions(ParticleState& state);

  std::vector<std::filesystem::path> files_;
  double interval_, spacing_;
  bool has_ids_ = false, has_velocities_ = false, has_rest_positions_ = false;
  std::size_t first_count_ = 0;
  std::map<std::size_t, ParticleState> cache_;
  std::map<std::uint64_t, Vec3> rest_positions_;  ///< By id; where the files have none.
  ParticleState state_;
};

}  // namespace flowskin::scenes
