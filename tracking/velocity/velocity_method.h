// Surface velocity from the field: the interface of all methods, and their registry.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tracking/field/implicit_field.h"
#include "tracking/mesh/adjacency.h"

namespace flowskin::tracking {

/// Computes the velocity of every vertex (m/s). Methods may look at the whole mesh.
class VelocityMethod {
 public:
  virtual ~VelocityMethod() = default;
  /// `positions` are the vertices at the time of `field` (m); `velocities` gets one entry per vertex. Never NaN: where
  /// nothing is known, zero. An empty `topology` means vertices without neighbours.
  virtual void evaluate(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<Vec3>& positions,
                        std::vector<Vec3>& velocities) const = 0;
};

/// One line of the registry.
struct VelocityMethodInfo {
  std::string name;
  std::string summary;  ///< One sentence: what it assumes and when to use it.
  std::unique_ptr<VelocityMethod> (*create)();
  bool needs_particle_velocities =
      false;  ///< The field alone is not enough: it must be one of particles that have some.
};

/// All methods, in the order of presentation.
const std::vector<VelocityMethodInfo>& velocity_methods();

/// True where the method of this name needs particle velocities.
bool needs_particle_velocities(const std::string& name);

/// @throws std::invalid_argument naming the valid methods, where there is none of this name.
std::unique_ptr<VelocityMethod> make_velocity_method(const std::string& name);

}  // namespace flowskin::tracking
