// What a simulation starts from: settings, fluids, bodies, emitters, sinks, walls.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sph/geometry/triangle_mesh.h"
#include "sph/setup/fluid.h"
#include "sph/setup/settings.h"
#include "sph/walls/boundary_motion.h"

namespace flowskin::sph {

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
  bool hollow =
      false;  ///< Whether the inside of a closed mesh may hold fluid; else fluid that begins there is left out.
  std::string name{};  ///< For messages; may be empty.
};

inline constexpr Range kSlip = at_least(0, 1);
/// At 1 fluid wets the wall fully (contact angle 0), beyond it spreads by force.
inline constexpr Range kAdhesion = at_least(0, 2);

/// Everything a simulation starts from.
struct SimulationSetup {
  SolverSettings settings;
  std::vector<Fluid> fluids;  ///< Empty: one, with the viscosity of the settings; else that one counts for nothing.
  std::vector<FluidBody> bodies;
  std::vector<Emitter> emitters;
  std::vector<Boundary> boundaries;
  std::vector<Sink> sinks;
};

}  // namespace flowskin::sph
