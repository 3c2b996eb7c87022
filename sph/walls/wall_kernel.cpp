#include "sph/walls/wall_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sph/forces/kernels.h"

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

// Distance of boundary particles in support radii. At 0.5 the friction on a particle half a spacing above the wall
// varies by 20 % with its place over the samples, at 0.4 by 2.6 %.
constexpr double sample_distance = 0.4;

// What a boundary particle in the middle of a plane of them sees: their kernel sum times the area of one (1/m).
template <typename Kernel>
double sample_sum(double radius, double distance) {
  double sum = 0;
  const int reach = static_cast<int>(std::ceil(radius / distance));
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) sum += Kernel::value(distance * std::hypot(i, j), radius);
  }
  return sum * distance * distance;
}

// What the first layer of a lattice lacks where nothing lies behind it.
struct Missing {
  double compression;  ///< share of the kernel sum
  double push;         ///< its gradient across the layer (1/m)
};

Missing missing_half(const SolverSettings& settings) {
  const double support = settings.support_radius * settings.spacing;
  double all = 0, behind = 0, push = 0;
  with_kernel(settings.kernel, [&](auto kernel) {
    for_lattice(settings, [&](double x, double y, double z) {
      const double r = std::hypot(x, y, z), w = decltype(kernel)::value(r, support);
      all += w;
      if (y >= 0) return;
      behind += w;
      // Both particles of a pair push: twice, as one boundary particle pushes with the fluid's pressure alone. The
      // layers behind also push the second layer, and so on, all of which the first has to pass on: times |y| layers.
      push += 2 * decltype(kernel)::derivative(r, support) * y / r * (-y / settings.spacing);
    });
  });
  return {behind / all, push / all};
}

}  // namespace

double lattice_kernel_sum(const SolverSettings& settings) {
  double sum = 0;
  for_lattice(settings, [&](double x, double y, double z) {
    sum += kernel_value(settings.kernel, std::hypot(x, y, z), settings.support_radius * settings.spacing);
  });
  return sum * cubed(settings.spacing);
}

double lattice_pressure_factor(const SolverSettings& settings) {
  const double support = settings.support_radius * settings.spacing;
  double virial = 0;
  with_kernel(settings.kernel, [&](auto kernel) {
    for_lattice(settings, [&](double x, double y, double z) {
      const double r = std::hypot(x, y, z);
      virial -= decltype(kernel)::derivative(r, support) * r / 3;
    });
  });
  return lattice_kernel_sum(settings) / (virial * cubed(settings.spacing));
}

double lattice_viscosity_scale(const SolverSettings& settings) {
  const double support = settings.support_radius * settings.spacing;
  double sum = 0;
  // The force on the particle at 0 in the flow v = (y^2 / 2, 0, 0), whose Laplacian is 1.
  for_lattice(settings, [&](double x, double y, double z) {
    const double r2 = x * x + y * y + z * z, u = std::max(0.0, 1 - std::sqrt(r2) / support);
    const double along = settings.viscosity_form == ViscosityForm::monaghan ? x * x : r2;
    sum += u * u * u * (2 - u) * along * 0.5 * y * y;
  });
  return 1 / sum;
}

WallKernel make_wall_kernel(const SolverSettings& settings) {
  WallKernel wall;
  const double spacing = settings.spacing, support = settings.support_radius * spacing;
  const Missing missing = missing_half(settings);
  with_kernel(settings.kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    const auto layer = [&](double d, double radius) {
      return plane_integral(d, radius, [&](double r, double) { return Kernel::value(r, radius); });
    };
    // Minus the derivative of layer(): the normal part of the gradient.
    const auto push = [&](double d, double radius) {
      return plane_integral(
          d, radius, [&](double r, double) { return Kernel::gradient_scale(radius) * Kernel::shape(r / radius) * d; });
    };
    // A plane of boundary particles adds layer(d) / layer(0) at distance d. How steep that is, for its height, falls
    // with the support radius; the volume factor then gives it the height.
    double low = 0.55 * spacing, high = 2 * support;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const bool too_steep =
          push(0.5 * spacing, middle) * missing.compression > missing.push * layer(0.5 * spacing, middle);
      (too_steep ? low : high) = middle;
    }
    const double radius = wall.support = 0.5 * (low + high);
    wall.sample_spacing = sample_distance * radius;
    const double samples = sample_sum<Kernel>(radius, wall.sample_spacing);
    wall.compression = missing.compression;
    wall.volume_factor = missing.compression * samples / layer(0.5 * spacing, radius);

    wall.area_factor = samples / wall.volume_factor;

    const double softening = 0.01 * radius * radius / 4;
    const bool monaghan = settings.viscosity_form == ViscosityForm::monaghan;
    const double drag = plane_integral(0.5 * spacing, radius, [&](double r, double s2) {
      const double s = Kernel::gradient_scale(radius) * Kernel::shape(r / radius) / (r * r + softening);
      return monaghan ? 10 * s * 0.5 * s2 : 2 * s * r * r;
    });
    wall.friction_factor = samples / (wall.volume_factor * drag * 0.5 * spacing * spacing);
  });
  return wall;
}

}  // namespace flowskin::sph
