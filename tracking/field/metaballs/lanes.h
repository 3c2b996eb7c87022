// Four doubles side by side: the compiler's vector type, the same on every processor. Internal to tracking/field.
#pragma once

namespace flowskin::tracking {

constexpr int lane_count = 4;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
using LaneMask = long long __attribute__((vector_size(lane_count * sizeof(long long))));

/// Sum in a fixed order, so that results never depend on anything but the numbers.
inline double lane_sum(const Lanes& a) { return (a[0] + a[2]) + (a[1] + a[3]); }

inline bool any_lane(const LaneMask& mask) { return ((mask[0] | mask[2]) | (mask[1] | mask[3])) != 0; }

}  // namespace flowskin::tracking
