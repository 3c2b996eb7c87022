// The flow of the particles around a point, by moving least squares of their velocities.
#pragma once

#include "tracking/field/particle_field.h"

namespace flowskin::tracking {

/// The linear flow v(y) = velocity + gradient (y - x) that fits the particles around x best.
struct LocalFlow {
  Vec3 velocity = Vec3::Zero();  ///< At x (m/s).
  Mat3 gradient = Mat3::Zero();  ///< gradient(i, j) = dv_i / dx_j (1/s)
  Vec3 center = Vec3::Zero();    ///< Weighted mean of the particles' places, from x (m).
  double gradient_error2 = 0;    ///< Expected |error|^2 of the gradient if the misfit is noise (1/s^2).
  double misfit = 0;             ///< Share of the velocities' spread that the linear flow leaves unexplained, 0 to 1:
                                 ///< root of sum w |v_i - fit|^2 / sum w |v_i - mean|^2. Zero where all are the same.
  int neighbors = 0;             ///< Particles nearer than the effective radius.
  bool defined = false;          ///< There are such particles; else all of the above is zero.
};

/// Moving least squares of first order [Lancaster and Salkauskas 1981] over the particles nearer than the effective
/// radius, with the field's kernel u^3 as weight. Exact for every linear flow where the particles span space. Of a
/// direction in which they do not spread (all in a plane, on a line, in one place) the gradient is completed by
/// antisymmetry, as if they turned without strain: two particles that circle each other turn, a single one does not.
/// Eigenvalues of their covariance below 1e-3 squared radii (a spread of 3 % of the radius) fade out. The misfit of
/// four particles or fewer says little, as a linear flow fits them in most cases. Never NaN; a field without velocities
/// is at rest.
LocalFlow local_flow(const ParticleField& field, const Vec3& x);
LocalFlow local_flow(const LocalParticles& field, const Vec3& x);

}  // namespace flowskin::tracking
