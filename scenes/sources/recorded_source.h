// Particles of a recorded sequence of files, whoever wrote it.
#pragma once

#include <cstdint>
#include <map>

#include "scenes/scene.h"
#include "scenes/sources/particle_sequence.h"
#include "scenes/sources/particle_source.h"

namespace flowskin::scenes {

/// Between files every particle, found again by its id, follows the cubic Hermite curve through its places and
/// velocities; one that is in only one of the two files goes straight on for the half of the interval next to that
/// file. A particle that jumps (tracking::JumpRule) is one that goes and one that comes. What the files do not tell is
/// made up for: velocities from differences over three files, rest positions from the first file that holds the
/// particle, or the first after a jump. Where it is unknown which particle is which, the particles of both files are
/// there, each moved by its velocity as far as it has one, with weights that go from one file to the other.
class RecordedSource : public ParticleSource {
 public:
  /// @throws InputError naming the file and what is wrong with it or with the sequence.
  explicit RecordedSource(const Scene& scene);

  const ParticleState& state() const override { return state_; }
  /// @throws InputError where a file cannot be read, or the sequence ends before `time`.
  void advance_to(double time) override;
  double spacing() const override { return spacing_; }
  SourceStatistics statistics() const override;
  std::vector<std::string> warnings() const override { return warnings_; }
  bool ends_before(double time) const override;
  void save(StateWriter& writer) const override;
  void restore(StateReader& reader) override;

 private:
  bool has_lasting_ids() const { return sequence_.ids != ParticleSequence::Ids::none; }
  /// The last file that is not after the present time.
  std::size_t nearest_file() const;
  /// File k as it is, with rest positions; a few files are kept.
  const ParticleState& file_state(std::size_t k);
  /// File k with velocities.
  ParticleState complete_state(std::size_t k);
  /// Reads file k into the cache.
  void read_into_cache(std::size_t k);
  /// Gives the particles of file k rest positions: where each was first, or came back after a jump.
  void settle_rest_positions(std::size_t k, ParticleState& state);
  /// Makes the rest positions what they were when the first of the cached files had been read.
  void take_back_renewals(const std::vector<std::uint64_t>& cached);

  /// A rest position that was replaced, since its particle jumped.
  struct Renewal {
    std::uint64_t file = 0;  ///< The first one after the jump.
    std::uint64_t id = 0;
    Vec3 before = Vec3::Zero();
    template <class Archive>
    void visit(Archive& archive) {
      archive(file, id, before);
    }
  };

  ParticleSequence sequence_;
  std::vector<std::string> warnings_;
  double spacing_;
  tracking::Walls walls_;
  std::map<std::size_t, ParticleState> cache_;
  std::map<std::size_t, LeftOut> left_out_;           ///< Of the files that have been read.
  std::map<std::uint64_t, Vec3> rest_positions_;      ///< By id; where the files have none.
  std::vector<Renewal> renewals_;                     ///< By the cached files, in the order in which they were made.
  std::map<std::uint64_t, std::uint32_t> checksums_;  ///< Of the files that have been read.
  ParticleState state_;
};

}  // namespace flowskin::scenes
