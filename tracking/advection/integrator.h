// Moves vertices with a surface velocity.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "common/named_value.h"
#include "tracking/field/implicit_field.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {

enum class Integrator { euler, rk2, rk4 };
inline constexpr std::array kIntegratorNames{NamedValue<Integrator>{"euler", Integrator::euler},
                                             NamedValue<Integrator>{"rk2", Integrator::rk2},
                                             NamedValue<Integrator>{"rk4", Integrator::rk4}};

/// The field at a time (s), built anew.
using FieldAt = std::function<std::shared_ptr<const ImplicitField>(double)>;

/// One step from `time` to `time + step` by Euler's method, the midpoint rule or the classical Runge-Kutta method.
/// @param field_now the field at `time`
/// @param first_velocity where not empty, the method's velocity at the given positions and time, known already (m/s)
/// @param positions the vertices (m), one per vertex of the mesh; moved.
void advect_step(const VelocityMethod& method, const MeshAdjacency& topology, Integrator integrator,
                 const ImplicitField& field_now, const FieldAt& field_at, double time, double step,
                 const std::vector<Vec3>& first_velocity, std::vector<Vec3>& positions);

}  // namespace flowskin::tracking
