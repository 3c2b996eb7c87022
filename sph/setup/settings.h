// The solver's settings, and the numbers and words that they may be.
#pragma once

#include <array>
#include <string_view>

#include "common/named_value.h"
#include "common/range.h"
#include "common/vectors.h"

namespace flowskin::sph {

enum class KernelType { cubic_spline, wendland_c2 };
inline constexpr std::array kKernelNames{NamedValue<KernelType>{"wendland_c2", KernelType::wendland_c2},
                                         NamedValue<KernelType>{"cubic_spline", KernelType::cubic_spline}};

/// How the density of a particle is found:
/// - summation: rho_i = rho_0 (V sum_j W_ij + sum_b V_b W_ib), scaled so that the lattice of the start has the rest
///   density; at a free surface, where neighbours are missing, never below the rest density. Cannot drift: it is a
///   function of the positions.
/// - continuity: d rho_i / dt = rho_0 V sum_j v_ij . grad W_ij, with density diffusion [Molteni and Colagrossi 2009].
///   Smoother pressure in calm flow, but drifts from the true distances of the particles in long and in very viscous
///   flow.
enum class DensityMethod { summation, continuity };
inline constexpr std::array kDensityMethodNames{NamedValue<DensityMethod>{"summation", DensityMethod::summation},
                                                NamedValue<DensityMethod>{"continuity", DensityMethod::continuity}};

/// Discrete form of the viscous force. Both give the same kinematic viscosity inside the fluid:
/// - monaghan: a_i = 10 nu sum V_j (v_ij . x_ij) / (r^2 + 0.01 h^2) grad W, along the line of the pair [Monaghan 2005,
///   Sect. 8; the factor is 2 (d + 2) in d dimensions]. Keeps angular momentum, does not slow a rigid rotation, and
///   meets the condition of a free surface without shear stress [Colagrossi et al. 2011].
/// - morris: a_i = 2 nu sum V_j (x_ij . grad W) / (r^2 + 0.01 h^2) v_ij, along the velocity difference [Morris et al.
///   1997]. Slows free bodies of fluid that turn.
enum class ViscosityForm { monaghan, morris };
inline constexpr std::array kViscosityFormNames{NamedValue<ViscosityForm>{"monaghan", ViscosityForm::monaghan},
                                                NamedValue<ViscosityForm>{"morris", ViscosityForm::morris}};

/// How the viscous force is integrated in time: with the other forces (explicit_steps: the step is limited by
/// viscous_cfl h^2 / nu), by a linear system every step (implicit: no such limit), or the cheaper of the two.
enum class ViscositySolver { automatic, explicit_steps, implicit };
inline constexpr std::array kViscositySolverNames{
    NamedValue<ViscositySolver>{"auto", ViscositySolver::automatic},
    NamedValue<ViscositySolver>{"explicit", ViscositySolver::explicit_steps},
    NamedValue<ViscositySolver>{"implicit", ViscositySolver::implicit}};

/// Physical and numerical settings; SI units. Defaults give a stable, nearly incompressible fluid.
struct SolverSettings {
  double spacing = 0;           ///< Initial distance of neighbouring particles (m); must be given.
  double support_radius = 2.0;  ///< Support radius of the kernel, in spacings (2: about 30 neighbours).
  KernelType kernel = KernelType::wendland_c2;
  double rest_density = 1000;  ///< kg/m^3
  double viscosity = 1e-6;     ///< Kinematic viscosity (m^2/s), laminar.
  ViscosityForm viscosity_form = ViscosityForm::monaghan;
  double surface_tension = 0;  ///< N/m; 0: none
  ViscositySolver viscosity_solver = ViscositySolver::automatic;
  double viscosity_tolerance = 1e-3;    ///< Implicit: error of the velocities over their change in the step.
  int viscosity_max_iterations = 1000;  ///< Implicit: more mean failure.
  Vec3 gravity{0, -9.81, 0};            ///< m/s^2
  double max_speed = 0;       ///< Fastest flow expected (m/s); 0: from heights, gravity and initial velocities.
  double speed_of_sound = 0;  ///< m/s; 0: ten times the fastest flow expected, so that density stays within 1 %.
  /// Added to the pressure everywhere (Pa), for fluid that fills its space: inside pipes, in periodic boxes. Then
  /// suction is possible, down to this pressure, and the particles stay evenly spread. 0: there are free surfaces, no
  /// suction.
  double background_pressure = 0;
  double xsph = 0;  ///< Share of XSPH smoothing in the velocity that moves particles, 0 to 1.
  /// Particles move along -grad C, C the concentration of particles, to even distances: with the velocity
  /// -particle_shifting R u grad C, R the support radius and u the fastest particle's speed [Lind et al. 2012; Sun et
  /// al. 2019]; 1 is a good value. Only for a constant amount of fluid that fills its space, with
  /// DensityMethod::continuity: the mean pressure is held at the background pressure, and suction has no limit. 0:
  /// none.
  double particle_shifting = 0;
  /// Share of the skin friction of boundary layers that are thinner than a particle, 0 to 1: where fluid runs over a
  /// wall that it has only just wetted, the wall resists as boundary-layer theory says and not as the coarse velocity
  /// gradient does. 0: none.
  double wall_drag = 0;
  DensityMethod density_method = DensityMethod::summation;
  double density_diffusion = 0.1;  ///< Continuity density only: coefficient delta of its diffusion; 0: none.
  double acoustic_cfl = 0.4;       ///< dt <= acoustic_cfl h / (c + |v|), h the smoothing length
  double viscous_cfl = 0.125;      ///< dt <= viscous_cfl h^2 / nu; monaghan, stiffer along the pair: half of it
  double force_cfl = 0.25;         ///< dt <= force_cfl sqrt(h / |a|)
  double capillary_cfl = 0.5;      ///< dt <= capillary_cfl sqrt(rho h^3 / (2 pi gamma))
  double max_time_step = 1e9;      ///< s
  double skin = 0;                 ///< Skin of the Verlet lists, in spacings; 0: the recommended one.
  /// Particles that leave it along an axis that is not periodic are removed and counted; no limit along axes where min
  /// and max are the same.
  Box domain;
  /// Axes along which the domain is periodic: its opposite faces are one and the same, for fluid and walls. Walls
  /// outside of it are cut off.
  std::array<bool, 3> periodic{};
};

using NumberSetting = NamedNumber<SolverSettings>;
/// What the numbers may be, in scene files and in set-ups made by a program alike. Upper ends without a comment only
/// catch slips: they lie far beyond all that has been simulated.
inline constexpr std::array kNumberSettings{
    NumberSetting{"spacing", &SolverSettings::spacing, above(0, 1e3), "m"},
    // From 1.5 on a particle of a cubic lattice has its 18 nearest others in reach, below 1.41 only 6. At 4 it has
    // eight times as many as by default.
    NumberSetting{"support_radius", &SolverSettings::support_radius, at_least(1.5, 4), "spacings"},
    NumberSetting{"rest_density", &SolverSettings::rest_density, above(0, 1e5), "kg/m^3"},
    NumberSetting{"viscosity", &SolverSettings::viscosity, at_least(0, 1e4), "m^2/s"},
    NumberSetting{"surface_tension", &SolverSettings::surface_tension, at_least(0, 1e4), "N/m"},
    // The residual is a sum of floats, exact to about 3e-7 of the velocities. From a tenth on the error would be seen.
    NumberSetting{"viscosity_tolerance", &SolverSettings::viscosity_tolerance, at_least(1e-6, 0.1), ""},
    NumberSetting{"max_speed", &SolverSettings::max_speed, at_least(0, 1e5), "m/s"},
    NumberSetting{"speed_of_sound", &SolverSettings::speed_of_sound, at_least(0, 1e5), "m/s"},
    NumberSetting{"background_pressure", &SolverSettings::background_pressure, at_least(0, 1e12), "Pa"},
    NumberSetting{"xsph", &SolverSettings::xsph, at_least(0, 1), ""},
    // A coefficient of order one; 1 is the usual value.
    NumberSetting{"particle_shifting", &SolverSettings::particle_shifting, at_least(0, 2), ""},
    NumberSetting{"wall_drag", &SolverSettings::wall_drag, at_least(0, 1), ""},
    // Diffusion is explicit in time and 2 delta h c its coefficient: with the default acoustic_cfl, steps of 0.4 h / c,
    // it comes near instability; 0.1 is usual.
    NumberSetting{"density_diffusion", &SolverSettings::density_diffusion, at_least(0, 0.5), ""},
    NumberSetting{"acoustic_cfl", &SolverSettings::acoustic_cfl, above(0, 2), ""},
    NumberSetting{"viscous_cfl", &SolverSettings::viscous_cfl, above(0, 1), ""},
    NumberSetting{"force_cfl", &SolverSettings::force_cfl, above(0, 2), ""},
    NumberSetting{"capillary_cfl", &SolverSettings::capillary_cfl, above(0, 2), ""},
    NumberSetting{"max_time_step", &SolverSettings::max_time_step, above(0, 1e9), "s"},
    // Each doubling of the lists' reach is eight times the entries: 2 doubles that of the default kernel.
    NumberSetting{"skin", &SolverSettings::skin, at_least(0, 2), "spacings"},
};
/// Of viscosity_max_iterations.
inline constexpr Range kViscosityIterations = at_least(1, 1e6);
/// Of each component of the gravity (m/s^2).
inline constexpr double kGreatestGravity = 1e4;

/// The range of one of the numbers.
consteval Range range_of(double SolverSettings::*value) { return range_in(kNumberSettings, value); }

}  // namespace flowskin::sph
