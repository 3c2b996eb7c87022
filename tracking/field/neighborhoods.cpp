#include "tracking/field/neighborhoods.h"

#include <algorithm>
#include <numeric>

#include "common/hilbert.h"
#include "tracking/field/field_parts.h"

namespace flowskin::tracking {
namespace {

// Chosen with tests/benchmarks/tracking_benchmark.cpp.
constexpr int chunk_size = 256;         // points
constexpr int largest_patch = 48;       // points
constexpr double patch_in_radii = 1.6;  // longest diagonal of a patch's box
constexpr double cell_in_radii = 0.25;  // finer cells would not change the order by much
constexpr int usual_groups = 32;        // around a point
constexpr double farthest = 1e150;      // m; a place beyond is none

/// All points along the curve; those that are not finite at the end.
std::vector<int> order_of(const std::vector<Vec3>& points, double cell) {
  // The curve needs differences of places.
  const auto finite = [](const Vec3& x) { return (x.array().abs() < farthest).all(); };
  if (std::all_of(points.begin(), points.end(), finite)) return hilbert_order(points, cell);
  std::vector<int> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  const auto middle = std::stable_partition(numbers.begin(), numbers.end(), [&](int i) { return finite(points[i]); });
  std::vector<Vec3> sound;
  for (auto i = numbers.begin(); i != middle; ++i) sound.push_back(points[*i]);
  std::vector<int> order = hilbert_order(sound, cell);
  for (int& i : order) i = numbers[i];
  order.insert(order.end(), middle, numbers.end());
  return order;
}

}  // namespace

auto LocalField::known() const {
  return [this](std::size_t part) {
    return GroupList(groups_ + begin_[part], static_cast<std::size_t>(begin_[part + 1] - begin_[part]));
  };
}

double LocalField::value(const Vec3& x) const { return knows(x) ? field_->impl_->value(x, known()) : field_->value(x); }

double LocalField::value(const Vec3& x, Vec3& gradient) const {
  return knows(x) ? field_->impl_->value(x, gradient, known()) : field_->value(x, gradient);
}

Jet LocalField::jet(const Vec3& x) const { return knows(x) ? field_->impl_->jet(x, known()) : field_->jet(x); }

KernelMoments LocalField::moments(const Vec3& x) const {
  return knows(x) ? field_->impl_->moments(x, known()) : field_->moments(x);
}

void LocalField::neighbors(const Vec3& x, std::vector<int>& found) const {
  const double radius = settings().radius;
  if (knows(x)) {
    field_->impl_->neighbors(x, radius, found, known());
  } else {
    field_->neighbors(x, radius, found);
  }
}

Neighborhoods::Neighborhoods(const MetaballField& field, const std::vector<Vec3>& points, double slack)
    : field_(&field),
      order_(order_of(points, cell_in_radii * field.settings().radius)),
      places_(points.size()),
      chunks_((points.size() + chunk_size - 1) / chunk_size) {
  const auto count = static_cast<int>(order_.size());
  const double reach = field.settings().radius + slack;
#pragma omp parallel for schedule(dynamic, 1) if (chunks_.size() > 1)
  for (int c = 0; c < static_cast<int>(chunks_.size()); ++c) {
    fill(field, points, reach, c * chunk_size, std::min(count, (c + 1) * chunk_size), chunks_[c]);
  }
  const std::size_t parts = field.impl_->parts.size();
  locals_.reserve(points.size());
  for (int i = 0; i < count; ++i) {
    const Chunk& chunk = chunks_[i / chunk_size];
    const int* const begin = chunk.begin.data() + static_cast<std::size_t>(i % chunk_size) * parts;
    locals_.push_back(LocalField(field, points[order_[i]], slack, chunk.groups.data(), begin));
    places_[order_[i]] = i;
  }
}

void Neighborhoods::fill(const MetaballField& field, const std::vector<Vec3>& points, double reach, int begin, int end,
                         Chunk& chunk) const {
  thread_local std::vector<std::vector<int>> boxes;  // of each part
  const std::vector<MetaballField::Impl::Part>& parts = field.impl_->parts;
  boxes.resize(std::max(boxes.size(), parts.size()));
  const double longest = patch_in_radii * field.settings().radius;
  chunk.begin.assign(1, 0);
  chunk.groups.reserve(std::size_t{chunk_size} * usual_groups);
  for (int first = begin, last = begin; first < end; first = last) {
    Vec3 low = points[order_[first]], high = low;
    for (last = first + 1; last < end && last - first < largest_patch; ++last) {
      const Vec3& next = points[order_[last]];
      const Vec3 new_low = low.cwiseMin(next), new_high = high.cwiseMax(next);
      if (!((new_high - new_low).squaredNorm() <= longest * longest)) break;
      low = new_low;
      high = new_high;
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
      parts[part].blocks->boxes_near(low, high, reach, boxes[part]);
    for (int i = first; i < last; ++i) {
      for (std::size_t part = 0; part < parts.size(); ++part) {
        parts[part].blocks->append_near(points[order_[i]], reach, boxes[part], chunk.groups);
        chunk.begin.push_back(static_cast<int>(chunk.groups.size()));
      }
    }
  }
}

}  // namespace flowskin::tracking
