// A weakly compressible SPH fluid: the public face of the solver.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/state_archive.h"
#include "sph/geometry/triangle_mesh.h"
#include "sph/walls/boundary_motion.h"

namespace flowskin::sph {

enum class KernelType { cubic_spline, wendland_c2 };

/// How the density of a particle is found:
/// - summation: rho_i = rho_0 (V sum_j W_ij + sum_b V_b W_ib), scaled so that the lattice of the start has the rest
/// density; at
///   a free surface, where neighbours are missing, never below the rest density. Cannot drift: it is a function of the
///   positions.
/// - continuity: d rho_i / dt = rho_0 V sum_j v_ij . grad W_ij, with density diffusion [Molteni and Colagrossi 2009].
/// Smoother
///   pressure in calm flow, but drifts from the true distances of the particles in long and in very viscous flow.
enum class DensityMethod { summation, continuity };

/// Discrete form of the viscous force. Both give the same kinematic viscosity inside the fluid:
/// - monaghan: a_i = 10 nu sum V_j (v_ij . x_ij) / (r^2 + 0.01 h^2) grad W, along the line of the pair [Monaghan 2005,
///   Sect. 8; the factor is 2 (d + 2) in d dimensions]. Keeps angular momentum, does not slow a rigid rotation, and
///   meets the condition of a free surface without shear stress [Colagrossi et al. 2011].
/// - morris: a_i = 2 nu sum V_j (x_ij . grad W) / (r^2 + 0.01 h^2) v_ij, along the velocity difference [Morris et al.
/// 1997].
///   Slows free bodies of fluid that turn.
enum class ViscosityForm { monaghan, morris };

/// How the viscous force is integrated in time: with the other forces (explicit_steps: the step is limited by
/// viscous_cfl h^2 / nu), by a linear system every step (implicit: no such limit), or the cheaper of the two.
enum class ViscositySolver { automatic, explicit_steps, implicit };

/// A setting is impossible (negative spacing, a fluid body without particles, ...); the message says which and why.
struct SettingsError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The simulation blew up (NaN, a speed or density over its limit); the message says when, which particle, the likely
/// cause and the setting to change.
struct BlowUpError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

/// How the viscosity depends on the shear rate g = sqrt(2 D:D): Herschel and Bulkley's law, regularised by
/// Papanastasiou [1987], eta = K g^(n - 1) + tau_y (1 - exp(-m g)) / g, at most rest density times max_viscosity.
struct Rheology {
  double consistency = 0;       ///< K (Pa s^n); 0: n = 1 and K = rest density times viscosity
  double flow_index = 1;        ///< n; below 1 thinner, above 1 thicker when sheared
  double yield_stress = 0;      ///< tau_y (Pa): below it the fluid hardly flows
  double regularization = 100;  ///< m (s): yields above shear rates of about 1/m
  double max_viscosity = 10;    ///< Kinematic (m^2/s); of all that does not yield

  bool is_newtonian() const { return consistency == 0 && yield_stress == 0; }
};

/// One of the fluids of a set-up. All have the rest density of the settings.
struct Fluid {
  std::string name;         ///< By which bodies and emitters refer to it.
  double viscosity = 1e-6;  ///< Kinematic viscosity (m^2/s), laminar.
  Rheology rheology;
};

/// A shape filled with fluid at the start, sampled on a lattice of the solver's spacing.
struct FluidBody {
  enum class Shape { block, ball, mesh };
  Shape shape = Shape::block;
  Box block;                             ///< shape block (m)
  Vec3 center = Vec3::Zero();            ///< shape ball (m)
  double radius = 0;                     ///< shape ball (m)
  TriangleMesh mesh;                     ///< shape mesh: a closed surface (m)
  std::vector<Box> cuts;                 ///< Boxes that are cut out of the shape (m), closed: their faces stay empty.
  Vec3 velocity = Vec3::Zero();          ///< Initial velocity (m/s).
  Vec3 angular_velocity = Vec3::Zero();  ///< Initial spin about the body's centroid (rad/s).
  std::string fluid;                     ///< Name of its fluid; empty: the first one.
};

/// An outlet that pours fluid along its axis.
struct Emitter {
  Vec3 center = Vec3::Zero();     ///< Disc, rectangle: middle of the outlet (m).
  Vec3 direction{0, -1, 0};       ///< Axis; normalised by the solver.
  double radius = 0;              ///< Disc (m).
  double speed = 0;               ///< m/s along the axis
  double start = 0, stop = 1e30;  ///< Pours while start <= t < stop (s).
  enum class Shape { disc, rectangle, mesh };
  Shape shape = Shape::disc;
  double width = 0, height = 0;     ///< Rectangle: edges across and along `up` (m).
  Vec3 up = Vec3::Zero();           ///< Rectangle: direction of the edge `height`; zero: z for jets along y, else y.
  TriangleMesh mesh{};              ///< Mesh: its shadow along the direction pours, from its foremost point on (m).
  std::uint64_t max_particles = 0;  ///< Pours whole layers up to so many particles; 0: any number.
  std::string fluid{};              ///< Name of its fluid; empty: the first one.
};

/// A region that removes the fluid which comes into it: at the latest when it is half a skin inside.
struct Sink {
  enum class Shape { box, ball, mesh };
  Shape shape = Shape::box;
  Box box;                        ///< shape box (m)
  Vec3 center = Vec3::Zero();     ///< shape ball (m)
  double radius = 0;              ///< shape ball (m)
  TriangleMesh mesh;              ///< shape mesh: a closed surface (m)
  double start = 0, stop = 1e30;  ///< Open while start <= t < stop (s).
};

/// A wall: any open or closed triangle surface.
struct Boundary {
  TriangleMesh mesh;
  double slip = 0;                       ///< 0: no-slip, 1: free slip; between: the share of wall friction taken away.
  BoundaryMotion motion{};               ///< Of the mesh; by default it rests.
  Vec3 surface_velocity = Vec3::Zero();  ///< Of the surface along the wall, as of a conveyor belt (m/s); turns with it.
  double adhesion = 0;  ///< Work of adhesion over 2 gamma: 0: not wetted, 0.5: contact angle 90 degrees, 1: wetted.
};

/// Everything a simulation starts from.
struct SimulationSetup {
  SolverSettings settings;
  std::vector<Fluid> fluids;  ///< Empty: one, with the viscosity of the settings; else that one counts for nothing.
  std::vector<FluidBody> bodies;
  std::vector<Emitter> emitters;
  std::vector<Boundary> boundaries;
  std::vector<Sink> sinks;
};

/// The fluid particles at one time, in order of ascending id. All arrays have one entry a particle.
struct FluidState {
  double time = 0;  ///< s
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> positions;   ///< m; inside the domain along periodic axes
  std::vector<Vec3> velocities;  ///< m/s
  std::vector<Vec3>
      rest_positions;  ///< Place of the material in the first frame (m); emitted particles continue the jet backwards.
  std::vector<double> densities;     ///< kg/m^3
  std::vector<std::uint8_t> fluids;  ///< Index into SimulationSetup::fluids; empty: there is only one.
  std::vector<float> viscosities;    ///< Kinematic (m^2/s); empty: the same for all.
};

/// Which limit set the time step, and all of them (s).
struct TimeStepReport {
  double step = 0, acoustic = 0, viscous = 0, force = 0, capillary = 0;
  std::string limited_by;  ///< "acoustic", "viscous", "force", "capillary", "output" or "setting"

  template <class Archive>
  void visit(Archive& archive) {
    archive(step, acoustic, viscous, force, capillary, limited_by);
  }
};

/// Counters since the start, and seconds spent per stage.
struct SolverStatistics {
  std::uint64_t steps = 0;
  std::uint64_t list_rebuilds = 0;
  std::uint64_t left_domain = 0;       ///< Particles removed because they left the domain.
  std::uint64_t wall_crossings = 0;    ///< Particle paths that would have passed a wall and were put back.
  std::uint64_t kept_out_of_gaps = 0;  ///< Particle paths that led into gaps narrower than the spacing.
  std::uint64_t squeezed_through = 0;  ///< Particles that moving walls left no room: they passed one.
  std::uint64_t emitted = 0;
  std::uint64_t not_emitted = 0;  ///< Particles that emitters left out because their places were taken.
  std::uint64_t drained = 0;      ///< Particles removed by sinks.
  std::uint64_t steps_limited_by_acoustic = 0, steps_limited_by_viscous = 0, steps_limited_by_force = 0;
  std::uint64_t viscosity_iterations = 0;  ///< Of the implicit viscosity, in all steps.
  double viscosity_tolerance = 0;          ///< Residual that the last implicit step asked for (m/s, root mean square).
  std::uint64_t steps_limited_by_capillary = 0;
  TimeStepReport last_step;
  double seconds_neighbors = 0, seconds_forces = 0, seconds_viscosity = 0, seconds_integration = 0;

  template <class Archive>
  void visit(Archive& archive) {
    archive(steps, list_rebuilds, left_domain, wall_crossings, squeezed_through, emitted, not_emitted, drained);
    archive(steps_limited_by_acoustic, steps_limited_by_viscous, steps_limited_by_force, steps_limited_by_capillary);
    archive(kept_out_of_gaps, last_step, viscosity_iterations, viscosity_tolerance);
    archive(seconds_neighbors, seconds_forces, seconds_viscosity, seconds_integration);
  }
};

/// Energies of the fluid (J).
struct Energy {
  double kinetic = 0, potential = 0;
};

class SolverImpl;

/// A running simulation. Results do not depend on the number of OpenMP threads.
class Solver {
 public:
  /// @throws SettingsError where the set-up is impossible.
  explicit Solver(SimulationSetup setup);
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Advances to time `time` (s) exactly, in as many adaptive steps as needed.
  /// @throws BlowUpError where the fluid blows up; the state of the last whole step stays readable.
  void advance_to(double time);
  /// The same, but asks after each step whether to stop early. Going on later, or saving, restoring and going on, gives
  /// the same results as if it had not stopped. @return false where it was stopped
  bool advance_towards(double time, const std::function<bool()>& stop);
  /// One adaptive step of at most `limit` seconds; returns its length.
  double step(double limit = 1e30);

  double time() const;
  std::size_t particle_count() const;
  std::size_t boundary_particle_count() const;
  /// Particles in the order of ascending id.
  FluidState state() const;
  /// Settings with all automatic values (speed of sound, fastest flow, skin) filled in.
  const SolverSettings& settings() const;
  const SolverStatistics& statistics() const;
  Energy energy() const;
  Vec3 momentum() const;  ///< kg m/s
  /// Bytes held by the solver's arrays, lists included.
  std::size_t memory_bytes() const;
  /// Boundary particles (m), for pictures and checks.
  std::vector<Vec3> boundary_positions() const;

  /// Saves all that the future depends on but the set-up; the solver goes on as if nothing had been.
  void save(StateWriter& writer) const;
  /// Makes this solver the one that was saved: with the same set-up, all that follows is the same, bit for bit.
  /// max_speed, speed_of_sound and the limits of the time step may be others than they were.
  /// @throws StateError where this is no state of a solver with this set-up; the solver is unusable then.
  void restore(StateReader& reader);

 private:
  std::unique_ptr<SolverImpl> impl_;
};

}  // namespace flowskin::sph
