// What a field that is made of particles knows beyond its value: the second, optional side of an implicit field.
#pragma once

#include <string>
#include <vector>

#include "common/vectors.h"
#include "tracking/field/kernel_moments.h"

namespace flowskin::tracking {

class ImplicitField;
class LocalField;

/// The particles of a field. Never changes; safe to use from many threads.
class ParticleField {
 public:
  virtual ~ParticleField() = default;

  /// How far a particle is felt (m).
  virtual double radius() const = 0;
  /// m
  virtual const std::vector<Vec3>& positions() const = 0;
  /// m/s, one per particle; empty where those of none are known.
  virtual const std::vector<Vec3>& velocities() const = 0;
  /// Indices of the particles nearer than `reach` (m), ascending. Clears `found` first.
  virtual void neighbors(const Vec3& x, double reach, std::vector<int>& found) const = 0;
  /// What tells how the field changes when its particles are strained.
  virtual KernelMoments moments(const Vec3& x) const = 0;

 protected:
  ParticleField() = default;
  ParticleField(const ParticleField&) = default;
  ParticleField& operator=(const ParticleField&) = default;
};

/// The same as seen from one point, like LocalField.
class LocalParticles {
 public:
  virtual ~LocalParticles() = default;
  /// Of which these are some.
  virtual const ParticleField& all() const = 0;
  /// Indices of the particles nearer than the effective radius, ascending. Clears `found` first.
  virtual void neighbors(const Vec3& x, std::vector<int>& found) const = 0;
  virtual KernelMoments moments(const Vec3& x) const = 0;

 protected:
  LocalParticles() = default;
  LocalParticles(const LocalParticles&) = default;
  LocalParticles& operator=(const LocalParticles&) = default;
};

/// The particles of a field that has some.
/// @throws std::invalid_argument naming the one who asked, where it has none
const ParticleField& particles_of(const ImplicitField& field, const std::string& who);

}  // namespace flowskin::tracking
