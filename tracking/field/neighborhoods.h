// The field around many points that are near each other, as the vertices of a mesh are.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {

/// The field around each of many points. They are sorted along the Hilbert curve, so that points that are near each
/// other are looked at after one another, and the field finds out together what matters to them (ImplicitField::near).
/// What comes out depends on the points alone, not on threads. The field must outlive it.
class Neighborhoods {
 public:
  /// @param slack how far from its point a place may be (m) to be evaluated without a lookup of its own. The larger,
  ///   the more is looked at in vain.
  explicit Neighborhoods(const ImplicitField& field, const std::vector<Vec3>& points, double slack = 0);
  Neighborhoods(const Neighborhoods&) = delete;
  Neighborhoods& operator=(const Neighborhoods&) = delete;

  const ImplicitField& field() const { return *field_; }
  const LocalField& at(int point) const { return locals_->at(places_[point]); }
  /// The points along the curve, in the order of for_each.
  const std::vector<int>& order() const { return order_; }
  /// The place of each point in that order.
  const std::vector<int>& places() const { return places_; }
  /// Calls visit(point, local) for every point, in parallel, points that are near each other after one another.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const auto count = static_cast<std::ptrdiff_t>(order_.size());
#pragma omp parallel for schedule(dynamic, 64) if (count > 256)  // threads cost more than a few points
    for (std::ptrdiff_t i = 0; i < count; ++i) visit(order_[i], locals_->at(i));
  }

 private:
  const ImplicitField* field_;
  std::vector<int> order_;                     // points along the curve; those that are not finite come last
  std::vector<int> places_;                    // of each point in the order
  std::unique_ptr<const LocalFields> locals_;  // in this order
};

}  // namespace flowskin::tracking
