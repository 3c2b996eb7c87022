// The field of one part at a point, from the groups of particles around it. Internal to tracking/field.
#pragma once

#include "tracking/field/jet.h"
#include "tracking/field/kernel_moments.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/field/metaballs/particle_blocks.h"

namespace flowskin::tracking {

/// A part's particles, the groups of them that are near a point (all that have a particle nearer than the radius, more
/// do no harm: they change no bit of any result), and the effective radius (m).
struct NearGroups {
  const ParticleBlocks& blocks;
  GroupList groups;
  double radius;
  double per_square;  ///< 1 / radius^2
};

/// Sum of the kernels u^3, u = 1 - |x - x_i|^2 / radius^2.
double kernel_sum(const NearGroups& near, const Vec3& x);
/// The same; `gradient_sum` is the sum of u^2 (x - x_i) (m), of which the gradient is made.
double kernel_sum(const NearGroups& near, const Vec3& x, Vec3& gradient_sum);
/// The jet that these settings make of the part.
MotionJet jet_of(const NearGroups& near, const Vec3& x, const FieldSettings& settings);
/// Adds the moments of the part times `share`.
void add_moments(const NearGroups& near, const Vec3& x, double share, KernelMoments& moments);

}  // namespace flowskin::tracking
