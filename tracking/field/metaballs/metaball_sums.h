// The sums over a point's neighbours from which its jet is put together. Internal to tracking/field.
#pragma once

#include <array>

#include "tracking/field/jet.h"
#include "tracking/field/metaballs/lanes.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tracking {

/// With e = (x - x_i) / sigma, u = 1 - |e|^2 and p = e . v_i the kernel (without its weight) is phi = u^3, and its
/// derivatives with respect to e are
///   phi_a   = -6 u^2 e_a
///   phi_ab  = 24 u e_a e_b - 6 u^2 d_ab
///   phi_abc = -48 e_a e_b e_c + 24 u (d_ab e_c + d_ac e_b + d_bc e_a).
/// The kernel moves with its particle: its time derivative at a fixed point is minus its derivative along v_i.
struct NeighborLanes {
  Lanes ex, ey, ez, u;
  Lanes vx, vy, vz;  ///< m/s
};

/// Adds up the neighbours of one point, in the order in which they are given.
class MetaballSums {
 public:
  /// Lanes that hold no neighbour must be zero throughout.
  void add(const NeighborLanes* lanes, int count, bool moving);
  /// The jet, in units, of the field that these settings make of the neighbours.
  MotionJet jet(const FieldSettings& settings) const;

 private:
  void add_value_gradient_hessian(const NeighborLanes* lanes, int count);
  void add_third(const NeighborLanes* lanes, int count);
  void add_value_and_gradient_rates(const NeighborLanes* lanes, int count);
  void add_hessian_rate(const NeighborLanes* lanes, int count);

  double u3_ = 0, u2_ = 0;
  std::array<double, 3> u2_e_{};  // u^2 e_a
  std::array<double, 6> u_ee_{};  // u e_a e_b; xx, xy, xz, yy, yz, zz
  std::array<double, 3> u_e_{};   // u e_a
  std::array<double, 10> eee_{};  // e_a e_b e_c; xxx, xxy, xxz, xyy, xyz, xzz, yyy, yyz, yzz, zzz
  double u2_p_ = 0, u_p_ = 0;
  std::array<double, 3> u_p_e_{};  // u p e_a
  std::array<double, 3> u2_v_{};   // u^2 v_a
  std::array<double, 6> p_ee_{};   // p e_a e_b
  std::array<double, 6> u_ev_{};   // u (e_a v_b + e_b v_a)
};

}  // namespace flowskin::tracking
