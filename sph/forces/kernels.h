// Smoothing kernels, as plain functions of the distance and as eight-lane shapes for the pair loop.
//
// Both kernels are written with the support radius R (W = 0 for r >= R); the smoothing length of the time step limits
// is h = R/2. The pair loop needs the gradient as grad W = -G s(r/R) (x_i - x_j), with a constant G and a shape s that
// has no division by r for the Wendland kernel.
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "sph/pairs/lanes.h"
#include "sph/setup/settings.h"

namespace flowskin::sph {

/// Wendland C2 kernel in three dimensions [Wendland 1995; Dehnen and Aly 2012, Table 1].
struct WendlandC2 {
  /// W(r) in 1/m^3.
  static double value(double r, double support) {
    const double q = r / support;
    if (q >= 1) return 0;
    const double u = 1 - q;
    return 21 / (2 * std::numbers::pi * support * support * support) * u * u * u * u * (1 + 4 * q);
  }
  /// dW/dr in 1/m^4.
  static double derivative(double r, double support) { return -gradient_scale(support) * shape(r / support) * r; }
  /// G in grad W = -G s(r/R) (x_i - x_j), in 1/m^5.
  static double gradient_scale(double support) { return 210 / (std::numbers::pi * std::pow(support, 5)); }
  /// s(q) in grad W = -G s(q) (x_i - x_j).
  static double shape(double q) { return q >= 1 ? 0 : (1 - q) * (1 - q) * (1 - q); }

  static Float8 shape(const Float8& q) {
    const Float8 u = max(broadcast(1.0F) - q, Float8{});
    return u * u * u;
  }
  /// W R^3.
  static Float8 scaled_value(const Float8& q) {
    constexpr float scale = static_cast<float>(21 / (2 * std::numbers::pi));
    const Float8 u = max(broadcast(1.0F) - q, Float8{});
    const Float8 u2 = u * u;
    return broadcast(scale) * u2 * u2 * (broadcast(1.0F) + broadcast(4.0F) * q);
  }
};

/// Cubic spline kernel (M4) in three dimensions, support radius 2h [Monaghan 1992, Sect. 7].
struct CubicSpline {
  static double value(double r, double support) {
    const double h = support / 2, q = r / h;
    const double scale = 1 / (std::numbers::pi * h * h * h);
    if (q >= 2) return 0;
    if (q >= 1) return scale * 0.25 * (2 - q) * (2 - q) * (2 - q);
    return scale * (1 - 1.5 * q * q + 0.75 * q * q * q);
  }
  static double derivative(double r, double support) { return -gradient_scale(support) * shape(r / support) * r; }
  static double gradient_scale(double support) { return 1 / (std::numbers::pi * std::pow(support / 2, 5)); }
  static double shape(double q) {
    const double s = 2 * q;
    if (s >= 2) return 0;
    return s >= 1 ? 0.75 * (2 - s) * (2 - s) / s : 3 - 2.25 * s;
  }

  static Float8 shape(const Float8& q) {
    const Float8 s = q + q;
    const Float8 t = max(broadcast(2.0F) - s, Float8{});
    const Float8 inner = broadcast(3.0F) - broadcast(2.25F) * s;
    const Float8 outer = broadcast(0.75F) * t * t / max(s, broadcast(1.0F));
    return s < broadcast(1.0F) ? inner : outer;
  }
  static Float8 scaled_value(const Float8& q) {
    constexpr float scale = static_cast<float>(8 / std::numbers::pi);
    const Float8 s = q + q;
    const Float8 t = max(broadcast(2.0F) - s, Float8{});
    const Float8 inner = broadcast(1.0F) + s * s * (broadcast(0.75F) * s - broadcast(1.5F));
    const Float8 outer = broadcast(0.25F) * t * t * t;
    return broadcast(scale) * (s < broadcast(1.0F) ? inner : outer);
  }
};

/// Calls `function` with the kernel type as an empty object: with_kernel(type, [&](auto kernel) { ... }).
template <typename Function>
decltype(auto) with_kernel(KernelType type, Function&& function) {
  if (type == KernelType::cubic_spline) return function(CubicSpline{});
  return function(WendlandC2{});
}

/// Calls `function` with std::true_type or std::false_type, so that a loop can be compiled for both.
template <typename Function>
void with_bool(bool value, Function function) {
  value ? function(std::true_type{}) : function(std::false_type{});
}

/// W(r) of either kernel, in 1/m^3.
inline double kernel_value(KernelType type, double r, double support) {
  return with_kernel(type, [&](auto kernel) { return decltype(kernel)::value(r, support); });
}

}  // namespace flowskin::sph
