// The field around many points that are near each other, as the vertices of a mesh are.
#pragma once

#include <cstddef>
#include <vector>

#include "tracking/field/metaball_field.h"

namespace flowskin::tracking {

/// The field as seen from one point, whose neighbours are known. Gives the same numbers, bit for bit, as the
/// MetaballField itself at any place; quickly at those within the slack of the point.
class LocalField {
 public:
  double value(const Vec3& x) const;
  /// Value and gradient.
  double value(const Vec3& x, Vec3& gradient) const;
  /// All derivatives of the particles' part of the field, in one pass over the neighbours.
  Jet jet(const Vec3& x) const;
  /// What tells how that part changes when its particles are strained.
  KernelMoments moments(const Vec3& x) const;
  /// Indices of the particles nearer than the effective radius, ascending. Clears `found` first.
  void neighbors(const Vec3& x, std::vector<int>& found) const;

  const MetaballField& field() const { return *field_; }
  const FieldSettings& settings() const { return field_->settings(); }

 private:
  friend class Neighborhoods;
  LocalField(const MetaballField& field, const Vec3& center, double slack, const int* groups, const int* begin)
      : field_(&field), center_(center), slack_squared_(slack * slack), groups_(groups), begin_(begin) {}
  bool knows(const Vec3& x) const { return (x - center_).squaredNorm() <= slack_squared_; }
  auto known() const;

  const MetaballField* field_;
  Vec3 center_;
  double slack_squared_;
  const int* groups_;  // of all points of a chunk
  const int* begin_;   // of those of each part, and one more
};

/// Which particles matter to each of many points. Points are sorted along the Hilbert curve and cut into patches; a
/// patch looks up the particles around it, and its points choose among those. What comes out depends on the points
/// alone, not on threads. Costs about 200 bytes per point. The field must outlive it.
class Neighborhoods {
 public:
  /// @param slack how far from its point a place may be (m) to be evaluated without a lookup of its own. The larger,
  ///   the more particles are looked at in vain.
  Neighborhoods(const MetaballField& field, const std::vector<Vec3>& points, double slack = 0);
  Neighborhoods(const Neighborhoods&) = delete;
  Neighborhoods& operator=(const Neighborhoods&) = delete;

  const MetaballField& field() const { return *field_; }
  const LocalField& at(int point) const { return locals_[places_[point]]; }
  /// The points along the curve, in the order of for_each.
  const std::vector<int>& order() const { return order_; }
  /// The place of each point in that order.
  const std::vector<int>& places() const { return places_; }
  /// Calls visit(point, local) for every point, in parallel, points that are near each other after one another.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const auto count = static_cast<std::ptrdiff_t>(order_.size());
#pragma omp parallel for schedule(dynamic, 64) if (count > 256)  // threads cost more than a few points
    for (std::ptrdiff_t i = 0; i < count; ++i) visit(order_[i], locals_[i]);
  }

 private:
  /// Consecutive points of the order; their lists are made by one thread.
  struct Chunk {
    std::vector<int> groups;
    std::vector<int> begin;  // for each point, of the groups of each part; one more at the end
  };
  void fill(const MetaballField& field, const std::vector<Vec3>& points, double reach, int begin, int end,
            Chunk& chunk) const;

  const MetaballField* field_;
  std::vector<int> order_;          // points along the curve; those that are not finite come last
  std::vector<int> places_;         // of each point in the order
  std::vector<Chunk> chunks_;       // of so many points each, in this order
  std::vector<LocalField> locals_;  // in this order; they point into the chunks
};

}  // namespace flowskin::tracking
