// Drops, and what their particles tell about their shape. Used by the validations and by the solver's own tests.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sph/solver.h"

namespace flowskin::tools {

using sph::FluidState;
using sph::Vec3;

/// A closed mesh around the ellipsoid with the semi-axes given (m), centred at 0: `rings` rings of quadrilaterals.
inline sph::TriangleMesh ellipsoid_mesh(const Vec3& axes, int rings) {
  sph::TriangleMesh mesh;
  const int sectors = 2 * rings;
  const auto add = [&](double polar, double azimuth) {
    const Vec3 unit(std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth));
    mesh.positions.push_back(axes.cwiseProduct(unit));
  };
  add(0, 0);
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) add(M_PI * i / rings, 2 * M_PI * j / sectors);
  }
  add(M_PI, 0);
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * sectors + j % sectors; };
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// A drop of fluid without gravity, with surface tension 1 N/m, density 1000 kg/m^3 and radius 0.1 m.
struct DropSetup {
  static constexpr double kRadius = 0.1, kTension = 1, kDensity = 1000;

  static sph::SimulationSetup plain(double spacings_per_radius, double viscosity) {
    sph::SimulationSetup setup;
    setup.settings.spacing = kRadius / spacings_per_radius;
    setup.settings.gravity.setZero();
    setup.settings.viscosity = viscosity;
    setup.settings.surface_tension = kTension;
    // The pressure 2 gamma / R compresses by 0.9 %; the automatic speed is for drops of any size.
    setup.settings.speed_of_sound = 1.5;
    return setup;
  }
  /// An ellipsoid `stretch` times as long along x as a ball of the same volume.
  static sph::SimulationSetup ellipsoid(double spacings_per_radius, double viscosity, double stretch) {
    sph::SimulationSetup setup = plain(spacings_per_radius, viscosity);
    sph::FluidBody body;
    body.shape = sph::FluidBody::Shape::mesh;
    body.mesh = ellipsoid_mesh(kRadius * Vec3(stretch, 1 / std::sqrt(stretch), 1 / std::sqrt(stretch)), 24);
    setup.bodies.push_back(body);
    return setup;
  }
  /// A cube of the ball's volume.
  static sph::SimulationSetup cube(double spacings_per_radius, double viscosity) {
    sph::SimulationSetup setup = plain(spacings_per_radius, viscosity);
    sph::FluidBody body;
    body.block = {Vec3::Constant(-0.806 * kRadius), Vec3::Constant(0.806 * kRadius)};
    setup.bodies.push_back(body);
    return setup;
  }
};

inline Vec3 centroid(const FluidState& state) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : state.positions) sum += p;
  return sum / static_cast<double>(state.positions.size());
}

/// (<x^2> - <y^2 + z^2> / 2) / <r^2>: proportional to the amplitude of mode 2 about the x axis.
inline double elongation(const FluidState& state) {
  const Vec3 c = centroid(state);
  Vec3 moments = Vec3::Zero();
  for (const Vec3& p : state.positions) moments += (p - c).cwiseAbs2();
  return (moments.x() - 0.5 * (moments.y() + moments.z())) / moments.sum();
}

/// Greatest distance from the centroid along one of 26 directions over the smallest, less 1: 0.73 for a cube, 0 for a
/// ball. The distance along a direction is that of the foremost particle plus half a spacing.
inline double asphericity(const FluidState& state, double spacing) {
  const Vec3 c = centroid(state);
  double least = 1e300, most = 0;
  for (int k = 0; k < 27; ++k) {
    const Vec3 direction = Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).cast<double>();
    if (direction.isZero()) continue;
    double reach = 0;
    for (const Vec3& p : state.positions) reach = std::max(reach, (p - c).dot(direction.normalized()));
    least = std::min(least, reach + 0.5 * spacing);
    most = std::max(most, reach + 0.5 * spacing);
  }
  return most / least - 1;
}

/// Radius of the ball with the particles' mean square distance from the centroid (m).
inline double gyration_ball(const FluidState& state) {
  const Vec3 c = centroid(state);
  double sum = 0;
  for (const Vec3& p : state.positions) sum += (p - c).squaredNorm();
  return std::sqrt(5.0 / 3 * sum / static_cast<double>(state.positions.size()));
}

/// Rayleigh's frequency of mode 2, sqrt(8 gamma / (rho R^3)), of a drop of `count` particles (1/s).
inline double rayleigh_frequency(std::size_t count, double spacing) {
  const double volume = static_cast<double>(count) * spacing * spacing * spacing;
  return std::sqrt(8 * DropSetup::kTension / (DropSetup::kDensity * volume / (4.0 / 3 * M_PI)));
}

struct Oscillation {
  double frequency = 0;  ///< rad/s, damping taken off
  double decay = 0;      ///< 1/s
};

/// Best fit of e^(-bt) (A cos wt + B sin wt) + C to values at the times.
inline Oscillation fit_oscillation(const std::vector<double>& times, const std::vector<double>& values,
                                   double frequency_guess) {
  double best = 1e300, best_w = 0, best_b = 0;
  const auto try_out = [&](double w, double b) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    double squares = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double e = std::exp(-b * (times[k] - times.front()));
      const Vec3 f(e * std::cos(w * times[k]), e * std::sin(w * times[k]), 1);
      matrix += f * f.transpose();
      right += values[k] * f;
      squares += values[k] * values[k];
    }
    const double rest = squares - right.dot(matrix.ldlt().solve(right));
    if (rest < best) best = rest, best_w = w, best_b = b;
  };
  double w_center = frequency_guess, b_center = 0.3 * frequency_guess;
  for (double width = 0.6; width > 1e-4; width *= 0.4) {
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        try_out(w_center + 0.1 * i * width * frequency_guess, b_center + 0.06 * j * width * frequency_guess);
      }
    }
    w_center = best_w;
    b_center = best_b;
  }
  return {std::hypot(best_w, best_b), best_b};
}

/// The oscillation of an ellipsoid's elongation over so many of Rayleigh's periods, the first fifth left out.
inline Oscillation measure_oscillation(sph::Solver& solver, double frequency, double periods) {
  std::vector<double> times, values;
  const double period = 2 * M_PI / frequency;
  for (int k = 8; k <= 40 * periods; ++k) {
    solver.advance_to(k * period / 40);
    times.push_back(solver.time());
    values.push_back(elongation(solver.state()));
  }
  return fit_oscillation(times, values, frequency);
}

/// Mean pressure (Pa) of the particles nearer than half the drop's radius to its centroid.
inline double core_pressure(const sph::Solver& solver) {
  const FluidState state = solver.state();
  const Vec3 c = centroid(state);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if ((state.positions[i] - c).norm() > 0.5 * DropSetup::kRadius) continue;
    const double sound = solver.settings().speed_of_sound;
    sum += DropSetup::kDensity * sound * sound / 7 * (std::pow(state.densities[i] / DropSetup::kDensity, 7) - 1);
    ++count;
  }
  return sum / count;
}

}  // namespace flowskin::tools
