// The implicit surface of a set of particles: metaballs with compact support [FMM13, Eq. 13].
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "tracking/field/implicit_field.h"
#include "tracking/field/metaballs/field_walls.h"
#include "tracking/field/particle_field.h"
#include "tracking/particles.h"

namespace flowskin::tracking {

/// How particles make a field. Defaults are documented in docs/field.md.
struct FieldSettings {
  double radius = 0;     ///< Effective radius sigma of a particle (m).
  double threshold = 0;  ///< T; the surface is where the sum of the kernels equals T.
  double weight = 1;     ///< w_i, the same for all particles.
  /// Field of a bare wall, in thresholds: below 1/2 it has no surface of its own. 0: the field knows no walls.
  double wall_share = 0.45;

  /// Of the fields that these settings make.
  FieldScale scale() const { return {radius, weight}; }
};

/// Radius `radius_in_spacings` times the spacing, and the threshold that puts the surface of a half space filled with a
/// lattice half a spacing outside the outermost layer, where the fluid ends: so the volume comes out right.
FieldSettings default_field_settings(double spacing, double radius_in_spacings = 2.5);

/// Particles that make a share of a field, and how that share changes.
struct FieldPart {
  std::vector<Vec3> positions;   ///< m
  std::vector<Vec3> velocities;  ///< m/s; may be empty: then they are taken to stand still
  double share = 1;              ///< Factor of the weights of all of these particles, 0 or more.
  double share_rate = 0;         ///< Its time derivative (1/s).
};

/// f(x) = sum_i w (1 - |x - x_i|^2 / sigma^2)^3 - T over the particles nearer than sigma; f > 0 inside.
/// A field of several parts is the sum of theirs, f = sum_k s_k F_k - T, with the time derivatives
/// f_t = sum_k (s_k dF_k/dt + ds_k/dt F_k) and alike for those of gradient and Hessian: with shares 1 - s and s it goes
/// from one field to another. Walls add the kernels of their points to the value and its gradient, f = sum_k s_k F_k +
/// sum_w s_w F_w - T: they say where the surface is. How it moves is told by the particles: jets and moments are theirs
/// alone. A snapshot at one time; safe to use from many threads.
class MetaballField final : public ImplicitField, public ParticleField {
 public:
  /// `velocities` may be empty: then the time derivatives of the jet are zero.
  MetaballField(std::vector<Vec3> positions, std::vector<Vec3> velocities, FieldSettings settings);
  explicit MetaballField(std::vector<FieldPart> parts, FieldSettings settings, FieldWalls walls = {});
  ~MetaballField() override;
  MetaballField(MetaballField&&) noexcept;
  MetaballField& operator=(MetaballField&&) noexcept;

  double value(const Vec3& x) const override;
  double value(const Vec3& x, Vec3& gradient) const override;
  /// The particles' part of the field, in one pass over the neighbours.
  MotionJet motion_jet(const Vec3& x) const override;
  FieldScale scale() const override { return settings().scale(); }
  /// Remembers the last grid.
  std::shared_ptr<const SparseGrid> on_grid(double spacing) const override;
  std::unique_ptr<const LocalFields> near(const std::vector<Vec3>& points, double slack) const override;
  const ParticleField* particles() const override { return this; }

  double radius() const override { return settings().radius; }
  /// Of all parts after one another.
  const std::vector<Vec3>& positions() const override;
  const std::vector<Vec3>& velocities() const override;
  void neighbors(const Vec3& x, double reach, std::vector<int>& found) const override;
  KernelMoments moments(const Vec3& x) const override;

  const FieldSettings& settings() const;
  /// Share of each particle; empty: 1 each.
  const std::vector<double>& shares() const;
  const FieldWalls& walls() const;

 private:
  friend class LocalMetaballs;
  friend class MetaballsNearby;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The field where others keep it too.
inline std::shared_ptr<const ImplicitField> shared_field(MetaballField field) {
  return std::make_shared<const MetaballField>(std::move(field));
}

}  // namespace flowskin::tracking
