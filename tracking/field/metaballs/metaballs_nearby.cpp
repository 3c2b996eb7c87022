// Which particles matter to each of many points: points are cut into patches, a patch looks up the particles around it,
// and its points choose among those. Costs about 200 bytes per point.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "tracking/field/metaballs/field_parts.h"

namespace flowskin::tracking {
namespace {

// Chosen with tests/benchmarks/tracking_benchmark.cpp.
constexpr int chunk_size = 256;         // points
constexpr int largest_patch = 48;       // points
constexpr double patch_in_radii = 1.6;  // longest diagonal of a patch's box
constexpr int usual_groups = 32;        // around a point

}  // namespace

/// The field around one point, whose neighbours are known.
class LocalMetaballs final : public LocalField, public LocalParticles {
  bool knows(const Vec3& x) const { return (x - center_).squaredNorm() <= slack_squared_; }
  auto known() const {
    return [this](std::size_t part) {
      return GroupList(groups_ + begin_[part], static_cast<std::size_t>(begin_[part + 1] - begin_[part]));
    };
  }

 public:
  /// @param groups of all points of a chunk  @param begin of those of each part, and one more
  LocalMetaballs(const MetaballField& field, const Vec3& center, double slack, const int* groups, const int* begin)
      : field_(&field), center_(center), slack_squared_(slack * slack), groups_(groups), begin_(begin) {}

  double value(const Vec3& x) const override { return knows(x) ? field_->impl_->value(x, known()) : field_->value(x); }
  double value(const Vec3& x, Vec3& gradient) const override {
    return knows(x) ? field_->impl_->value(x, gradient, known()) : field_->value(x, gradient);
  }
  MotionJet motion_jet(const Vec3& x) const override {
    return knows(x) ? field_->impl_->jet(x, known()) : field_->motion_jet(x);
  }
  FieldScale scale() const override { return field_->scale(); }
  const LocalParticles* particles() const override { return this; }

  const ParticleField& all() const override { return *field_; }
  void neighbors(const Vec3& x, std::vector<int>& found) const override {
    const double radius = field_->radius();
    if (knows(x)) {
      field_->impl_->neighbors(x, radius, found, known());
    } else {
      field_->neighbors(x, radius, found);
    }
  }
  KernelMoments moments(const Vec3& x) const override {
    return knows(x) ? field_->impl_->moments(x, known()) : field_->moments(x);
  }

 private:
  const MetaballField* field_;
  Vec3 center_;
  double slack_squared_;
  const int* groups_;
  const int* begin_;
};

class MetaballsNearby final : public LocalFields {
 public:
  MetaballsNearby(const MetaballField& field, const std::vector<Vec3>& points, double slack)
      : field_(&field), chunks_((points.size() + chunk_size - 1) / chunk_size) {
    const auto count = static_cast<int>(points.size());
    const double reach = field.settings().radius + slack;
#pragma omp parallel for schedule(dynamic, 1) if (chunks_.size() > 1)
    for (int c = 0; c < static_cast<int>(chunks_.size()); ++c) {
      fill(points, reach, c * chunk_size, std::min(count, (c + 1) * chunk_size), chunks_[c]);
    }
    const std::size_t parts = field.impl_->parts.size();
    locals_.reserve(points.size());
    for (int i = 0; i < count; ++i) {
      const Chunk& chunk = chunks_[i / chunk_size];
      const int* const begin = chunk.begin.data() + static_cast<std::size_t>(i % chunk_size) * parts;
      locals_.emplace_back(field, points[i], slack, chunk.groups.data(), begin);
    }
  }
  const LocalField& at(std::size_t point) const override { return locals_[point]; }

 private:
  /// Consecutive points; their lists are made by one thread.
  struct Chunk {
    std::vector<int> groups;
    std::vector<int> begin;  // for each point, of the groups of each part; one more at the end
  };
  void fill(const std::vector<Vec3>& points, double reach, int begin, int end, Chunk& chunk) const;

  const MetaballField* field_;
  std::vector<Chunk> chunks_;           // of so many points each, in their order
  std::vector<LocalMetaballs> locals_;  // they point into the chunks
};

void MetaballsNearby::fill(const std::vector<Vec3>& points, double reach, int begin, int end, Chunk& chunk) const {
  thread_local std::vector<std::vector<int>> boxes;  // of each part
  const std::vector<MetaballField::Impl::Part>& parts = field_->impl_->parts;
  boxes.resize(std::max(boxes.size(), parts.size()));
  const double longest = patch_in_radii * field_->settings().radius;
  chunk.begin.assign(1, 0);
  chunk.groups.reserve(std::size_t{chunk_size} * usual_groups);
  for (int first = begin, last = begin; first < end; first = last) {
    Vec3 low = points[first], high = low;
    for (last = first + 1; last < end && last - first < largest_patch; ++last) {
      const Vec3& next = points[last];
      const Vec3 new_low = low.cwiseMin(next), new_high = high.cwiseMax(next);
      if (!((new_high - new_low).squaredNorm() <= longest * longest)) break;
      low = new_low;
      high = new_high;
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
      parts[part].blocks->boxes_near(low, high, reach, boxes[part]);
    for (int i = first; i < last; ++i) {
      for (std::size_t part = 0; part < parts.size(); ++part) {
        parts[part].blocks->append_near(points[i], reach, boxes[part], chunk.groups);
        chunk.begin.push_back(static_cast<int>(chunk.groups.size()));
      }
    }
  }
}

std::unique_ptr<const LocalFields> MetaballField::near(const std::vector<Vec3>& points, double slack) const {
  return std::make_unique<MetaballsNearby>(*this, points, slack);
}

}  // namespace flowskin::tracking
