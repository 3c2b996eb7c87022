#include "sph/wall_kernel.h"

#include <cmath>
#include <numbers>

#include "sph/kernels.h"

namespace flowskin::sph {

namespace {

// Integral of f(r, s) over a plane at distance d, r = sqrt(d^2 + s^2) < support; midpoint rule in s^2.
template <typename Function>
double plane_integral(double d, double support, Function f) {
  constexpr int pieces = 2000;
  const double end = support * support - d * d;
  if (end <= 0) return 0;
  double sum = 0;
  for (int k = 0; k < pieces; ++k) {
    const double s2 = (k + 0.5) * end / pieces;
    sum += f(std::sqrt(d * d + s2), s2);
  }
  return std::numbers::pi * sum * end / pieces;
}

// Calls f(x, y, z) for all points of the unit lattice in the support, in metres.
template <typename Function>
void for_lattice(const SolverSettings& settings, Function f) {
  const int reach = static_cast<int>(std::ceil(settings.support_radius));
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) f(i * settings.spacing, j * settings.spacing, k * settings.spacing);
    }
  }
}

double cubed(double x) { return x * x * x; }

}  // namespace

double lattice_kernel_sum(const SolverSettings& settings) {
  double sum = 0;
  for_lattice(settings, [&](double x, double y, double z) {
    sum += kernel_value(settings.kernel, std::hypot(x, y, z), settings.support_radius * settings.spacing);
  });
  return sum * cubed(settings.spacing);
}

double lattice_viscosity_factor(const SolverSettings& settings) {
  const double support = settings.support_radius * settings.spacing, softening = 0.01 * support * support / 4;
  const bool monaghan = settings.viscosity_form == ViscosityForm::monaghan;
  double sum = 0;
  with_kernel(settings.kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    // The force on the particle at 0 in the flow v = (y^2 / 2, 0, 0), whose Laplacian is 1.
    for_lattice(settings, [&](double x, double y, double z) {
      const double r2 = x * x + y * y + z * z;
      const double s = Kernel::gradient_scale(support) * Kernel::shape(std::sqrt(r2) / support) / (r2 + softening);
      sum += r2 == 0 ? 0 : monaghan ? 10 * s * 0.5 * y * y * x * x : 2 * s * r2 * 0.5 * y * y;
    });
  });
  return 1 / (sum * cubed(settings.spacing));
}

WallKernel make_wall_kernel(const SolverSettings& settings) {
  WallKernel wall;
  const double spacing = settings.spacing, support = settings.support_radius * spacing;
  // What the first layer of a lattice lacks where nothing lies behind it: half of all but its own layer.
  double own_layer = 0, all = 0;
  for_lattice(settings, [&](double x, double y, double z) {
    const double w = kernel_value(settings.kernel, std::hypot(x, y, z), support);
    all += w;
    if (y == 0) own_layer += w;
  });
  const double missing = 0.5 * (1 - own_layer / all);

  with_kernel(settings.kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    const auto layer = [&](double d, double radius) {
      return plane_integral(d, radius, [&](double r, double) { return Kernel::value(r, radius); });
    };
    // A plane of boundary particles adds layer(d) / layer(0) at distance d; this grows with the support radius.
    double low = 0.5 * spacing, high = 2 * support;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (layer(0.5 * spacing, middle) / layer(0, middle) < missing ? low : high) = middle;
    }
    const double radius = wall.support = 0.5 * (low + high);
    wall.sample_spacing = 0.5 * radius;

    const double softening = 0.01 * radius * radius / 4;
    const bool monaghan = settings.viscosity_form == ViscosityForm::monaghan;
    const double drag = plane_integral(0.5 * spacing, radius, [&](double r, double s2) {
      const double s = Kernel::gradient_scale(radius) * Kernel::shape(r / radius) / (r * r + softening);
      return monaghan ? 10 * s * 0.5 * s2 : 2 * s * r * r;
    });
    wall.friction_factor = layer(0, radius) / (drag * 0.5 * spacing * spacing);
  });
  return wall;
}

}  // namespace flowskin::sph
