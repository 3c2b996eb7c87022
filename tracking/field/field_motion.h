// How a field goes from one state to the next.
#pragma once

#include <memory>

#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {

/// A field over the time between two states, as Tracker::advance follows it: the way to track whatever is not made of
/// particles. Those have ParticlePaths.
class FieldMotion {
 public:
  virtual ~FieldMotion() = default;
  virtual double begin_time() const = 0;  ///< s
  virtual double end_time() const = 0;    ///< s
  /// The field at a time from begin to end, with the time derivatives that it has within this motion.
  virtual std::shared_ptr<const ImplicitField> field(double time) const = 0;
  /// How far any place of the surface moves from begin to end, or an estimate (m). Decides the number of substeps.
  virtual double longest_path() const = 0;
};

}  // namespace flowskin::tracking
