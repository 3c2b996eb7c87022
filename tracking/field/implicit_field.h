// A surface as the zero of a function: all that the tracker knows of what it follows.
#pragma once

#include <memory>
#include <vector>

#include "tracking/field/jet.h"

namespace flowskin::tracking {

class LocalField;
class LocalFields;
class ParticleField;  // tracking/field/particle_field.h
class SparseGrid;     // tracking/extraction/sparse_grid.h

/// In these units the lengths and derivatives of a field are of order one.
struct FieldScale {
  double length = 0;  ///< Of its finest detail (m): the effective radius of particles, a few voxels of a volume.
  double value = 1;   ///< By how much f changes over that length: the weight of a kernel, that length of a distance.
};

/// f(x) at one time; f > 0 inside. Never changes; safe to use from many threads.
class ImplicitField {
 public:
  virtual ~ImplicitField() = default;

  virtual double value(const Vec3& x) const = 0;
  /// Value and gradient.
  virtual double value(const Vec3& x, Vec3& gradient) const = 0;
  /// All derivatives of the part of the field that moves: MotionJet says where that is not all of it.
  virtual MotionJet motion_jet(const Vec3& x) const = 0;
  virtual FieldScale scale() const = 0;

  /// The field at the nodes of a grid of this spacing (m), kept in all blocks that its surface may cross. What the grid
  /// does not keep lies outside. Asked for again with the same spacing it may be the same grid.
  virtual std::shared_ptr<const SparseGrid> on_grid(double spacing) const = 0;

  /// The field around many points, of which neighbours follow each other. One that finds out once what many places have
  /// in common (which particles, which voxels matter) is quicker than the field itself; by default it is just that.
  /// @param slack how far from its point a place may be (m) to be evaluated quickly
  virtual std::unique_ptr<const LocalFields> near(const std::vector<Vec3>& points, double slack) const;

  /// The particles that make it; null where it is not made of particles.
  virtual const ParticleField* particles() const { return nullptr; }

 protected:
  ImplicitField() = default;
  ImplicitField(const ImplicitField&) = default;
  ImplicitField& operator=(const ImplicitField&) = default;
};

class LocalParticles;  // tracking/field/particle_field.h

/// The field as seen from one point. Gives the same numbers, bit for bit, as the field itself at any place; quickly at
/// those within the slack of the point.
class LocalField {
 public:
  virtual ~LocalField() = default;
  virtual double value(const Vec3& x) const = 0;
  virtual double value(const Vec3& x, Vec3& gradient) const = 0;
  virtual MotionJet motion_jet(const Vec3& x) const = 0;
  virtual FieldScale scale() const = 0;
  /// As ImplicitField::particles().
  virtual const LocalParticles* particles() const { return nullptr; }

 protected:
  LocalField() = default;
  LocalField(const LocalField&) = default;
  LocalField& operator=(const LocalField&) = default;
};

/// One LocalField for each of the points of ImplicitField::near, in their order.
class LocalFields {
 public:
  virtual ~LocalFields() = default;
  virtual const LocalField& at(std::size_t point) const = 0;

 protected:
  LocalFields() = default;
  LocalFields(const LocalFields&) = default;
  LocalFields& operator=(const LocalFields&) = default;
};

}  // namespace flowskin::tracking
