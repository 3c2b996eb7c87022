#include "tracking/field/metaballs/metaball_sums.h"

namespace flowskin::tracking {
namespace {

Mat3 symmetric(const std::array<double, 6>& m) {
  Mat3 full;
  full << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
  return full;
}

Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

// Each of the following walks over the same few cache lines with as many sums as there are registers.

void MetaballSums::add_value_gradient_hessian(const NeighborLanes* lanes, int count) {
  Lanes u3{}, u2{}, gx{}, gy{}, gz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  for (int i = 0; i < count; ++i) {
    const NeighborLanes& n = lanes[i];
    const Lanes uu = n.u * n.u;
    const Lanes ux = n.u * n.ex;
    const Lanes uy = n.u * n.ey;
    u3 += uu * n.u;
    u2 += uu;
    gx += uu * n.ex;
    gy += uu * n.ey;
    gz += uu * n.ez;
    xx += ux * n.ex;
    xy += ux * n.ey;
    xz += ux * n.ez;
    yy += uy * n.ey;
    yz += uy * n.ez;
    zz += n.u * n.ez * n.ez;
  }
  u3_ += lane_sum(u3);
  u2_ += lane_sum(u2);
  u2_e_[0] += lane_sum(gx);
  u2_e_[1] += lane_sum(gy);
  u2_e_[2] += lane_sum(gz);
  u_ee_[0] += lane_sum(xx);
  u_ee_[1] += lane_sum(xy);
  u_ee_[2] += lane_sum(xz);
  u_ee_[3] += lane_sum(yy);
  u_ee_[4] += lane_sum(yz);
  u_ee_[5] += lane_sum(zz);
}

void MetaballSums::add_third(const NeighborLanes* lanes, int count) {
  Lanes ux{}, uy{}, uz{}, xxx{}, xxy{}, xxz{}, xyy{}, xyz{}, xzz{}, yyy{}, yyz{}, yzz{}, zzz{};
  for (int i = 0; i < count; ++i) {
    const NeighborLanes& n = lanes[i];
    const Lanes xx = n.ex * n.ex;
    const Lanes yy = n.ey * n.ey;
    const Lanes zz = n.ez * n.ez;
    const Lanes xy = n.ex * n.ey;
    ux += n.u * n.ex;
    uy += n.u * n.ey;
    uz += n.u * n.ez;
    xxx += xx * n.ex;
    xxy += xx * n.ey;
    xxz += xx * n.ez;
    xyy += xy * n.ey;
    xyz += xy * n.ez;
    xzz += zz * n.ex;
    yyy += yy * n.ey;
    yyz += yy * n.ez;
    yzz += zz * n.ey;
    zzz += zz * n.ez;
  }
  u_e_[0] += lane_sum(ux);
  u_e_[1] += lane_sum(uy);
  u_e_[2] += lane_sum(uz);
  eee_[0] += lane_sum(xxx);
  eee_[1] += lane_sum(xxy);
  eee_[2] += lane_sum(xxz);
  eee_[3] += lane_sum(xyy);
  eee_[4] += lane_sum(xyz);
  eee_[5] += lane_sum(xzz);
  eee_[6] += lane_sum(yyy);
  eee_[7] += lane_sum(yyz);
  eee_[8] += lane_sum(yzz);
  eee_[9] += lane_sum(zzz);
}

void MetaballSums::add_value_and_gradient_rates(const NeighborLanes* lanes, int count) {
  Lanes u2p{}, up{}, upx{}, upy{}, upz{}, wx{}, wy{}, wz{};
  for (int i = 0; i < count; ++i) {
    const NeighborLanes& n = lanes[i];
    const Lanes p = n.ex * n.vx + n.ey * n.vy + n.ez * n.vz;
    const Lanes uu = n.u * n.u;
    const Lanes u_p = n.u * p;
    u2p += uu * p;
    up += u_p;
    upx += u_p * n.ex;
    upy += u_p * n.ey;
    upz += u_p * n.ez;
    wx += uu * n.vx;
    wy += uu * n.vy;
    wz += uu * n.vz;
  }
  u2_p_ += lane_sum(u2p);
  u_p_ += lane_sum(up);
  u_p_e_[0] += lane_sum(upx);
  u_p_e_[1] += lane_sum(upy);
  u_p_e_[2] += lane_sum(upz);
  u2_v_[0] += lane_sum(wx);
  u2_v_[1] += lane_sum(wy);
  u2_v_[2] += lane_sum(wz);
}

void MetaballSums::add_hessian_rate(const NeighborLanes* lanes, int count) {
  Lanes pxx{}, pxy{}, pxz{}, pyy{}, pyz{}, pzz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  for (int i = 0; i < count; ++i) {
    const NeighborLanes& n = lanes[i];
    const Lanes p = n.ex * n.vx + n.ey * n.vy + n.ez * n.vz;
    const Lanes px = p * n.ex;
    const Lanes py = p * n.ey;
    pxx += px * n.ex;
    pxy += px * n.ey;
    pxz += px * n.ez;
    pyy += py * n.ey;
    pyz += py * n.ez;
    pzz += p * n.ez * n.ez;
    const Lanes ux = n.u * n.ex;
    const Lanes uy = n.u * n.ey;
    const Lanes uz = n.u * n.ez;
    xx += ux * n.vx;
    xy += ux * n.vy + uy * n.vx;
    xz += ux * n.vz + uz * n.vx;
    yy += uy * n.vy;
    yz += uy * n.vz + uz * n.vy;
    zz += uz * n.vz;
  }
  p_ee_[0] += lane_sum(pxx);
  p_ee_[1] += lane_sum(pxy);
  p_ee_[2] += lane_sum(pxz);
  p_ee_[3] += lane_sum(pyy);
  p_ee_[4] += lane_sum(pyz);
  p_ee_[5] += lane_sum(pzz);
  u_ev_[0] += 2 * lane_sum(xx);
  u_ev_[1] += lane_sum(xy);
  u_ev_[2] += lane_sum(xz);
  u_ev_[3] += 2 * lane_sum(yy);
  u_ev_[4] += lane_sum(yz);
  u_ev_[5] += 2 * lane_sum(zz);
}

void MetaballSums::add(const NeighborLanes* lanes, int count, bool moving) {
  add_value_gradient_hessian(lanes, count);
  add_third(lanes, count);
  if (!moving) return;
  add_value_and_gradient_rates(lanes, count);
  add_hessian_rate(lanes, count);
}

MotionJet MetaballSums::jet(const FieldSettings& settings) const {
  const double w = settings.weight;
  const double first = w / settings.radius;  // d/dx = (1 / sigma) d/de
  const double second = first / settings.radius;
  const double third = second / settings.radius;
  MotionJet jet;
  jet.moving_value = w * u3_ - settings.threshold;
  jet.gradient = -6 * first * vector(u2_e_);
  jet.hessian = 24 * second * symmetric(u_ee_);
  jet.hessian.diagonal().array() -= 6 * second * u2_;

  const auto& t = eee_;
  jet.third[0] = -48 * third * symmetric({t[0], t[1], t[2], t[3], t[4], t[5]});
  jet.third[1] = -48 * third * symmetric({t[1], t[3], t[4], t[6], t[7], t[8]});
  jet.third[2] = -48 * third * symmetric({t[2], t[4], t[5], t[7], t[8], t[9]});
  const Vec3 line = 24 * third * vector(u_e_);
  for (int c = 0; c < 3; ++c) {
    jet.third[c].diagonal().array() += line[c];
    jet.third[c].row(c) += line.transpose();
    jet.third[c].col(c) += line;
  }

  jet.value_rate = 6 * first * u2_p_;
  jet.gradient_rate = second * (6 * vector(u2_v_) - 24 * vector(u_p_e_));
  jet.hessian_rate = third * (48 * symmetric(p_ee_) - 24 * symmetric(u_ev_));
  jet.hessian_rate.diagonal().array() -= 24 * third * u_p_;
  return jet;
}

}  // namespace flowskin::tracking
