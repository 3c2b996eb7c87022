#include "tracking/field/neighborhoods.h"

#include <algorithm>
#include <numeric>

#include "common/hilbert.h"

namespace flowskin::tracking {
namespace {

constexpr double cell_in_scales = 0.25;   // finer cells would not change the order by much
constexpr double kFarthestPlace = 1e150;  // m; a place beyond is none

/// All points along the curve; those that are not finite at the end.
std::vector<int> order_of(const std::vector<Vec3>& points, double cell) {
  // The curve needs differences of places.
  const auto finite = [](const Vec3& x) { return (x.array().abs() < kFarthestPlace).all(); };
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

Neighborhoods::Neighborhoods(const ImplicitField& field, const std::vector<Vec3>& points, double slack)
    : field_(&field), order_(order_of(points, cell_in_scales * field.scale().length)), places_(points.size()) {
  std::vector<Vec3> sorted(points.size());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    sorted[i] = points[order_[i]];
    places_[order_[i]] = i;
  }
  locals_ = field.near(sorted, slack);
}

}  // namespace flowskin::tracking
