#include "scenes/sources/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/errors.h"
#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

using std::numbers::pi;

double square(double x) { return x * x; }

/// Largest absolute slope of a field with the one number `rate` in it.
double rate_gradient(const MotionSpec& m) { return std::abs(m.rate); }

// ---- Rotation: v = w x (p - c).

Vec3 rotation_field(const MotionSpec& m, const Vec3& x, double) { return m.angular_velocity.cross(x - m.center); }
Vec3 rotation_path(const MotionSpec& m, const Vec3& x, double t) {
  const double speed = m.angular_velocity.norm();
  if (speed == 0) return x;
  return m.center + Eigen::AngleAxisd(speed * t, m.angular_velocity / speed) * (x - m.center);
}
double rotation_gradient(const MotionSpec& m) { return m.angular_velocity.norm(); }

// ---- Translation: nothing moves in the frame that is carried along.

Vec3 translation_field(const MotionSpec&, const Vec3&, double) { return Vec3::Zero(); }
Vec3 translation_path(const MotionSpec&, const Vec3& x, double) { return x; }
double translation_gradient(const MotionSpec&) { return 0; }

// ---- Shear: v = (s y, 0, 0).

Vec3 shear_field(const MotionSpec& m, const Vec3& x, double) { return {m.rate * x.y(), 0, 0}; }
Vec3 shear_path(const MotionSpec& m, const Vec3& x, double t) { return {x.x() + m.rate * x.y() * t, x.y(), x.z()}; }

// ---- Motions about an axis: a place is its coordinate z along the axis and the vector r across it.

struct AxialPlace {
  Vec3 axis;
  double along;
  Vec3 across;
};
AxialPlace axial(const MotionSpec& m, const Vec3& x) {
  const Vec3 axis = m.axis.normalized(), from_center = x - m.center;
  const double along = axis.dot(from_center);
  return {axis, along, from_center - along * axis};
}

// Stretch: v = s (z a - r / 2).
Vec3 stretch_field(const MotionSpec& m, const Vec3& x, double) {
  const AxialPlace p = axial(m, x);
  return m.rate * (p.along * p.axis - 0.5 * p.across);
}
Vec3 stretch_path(const MotionSpec& m, const Vec3& x, double t) {
  const AxialPlace p = axial(m, x);
  return m.center + std::exp(m.rate * t) * p.along * p.axis + std::exp(-0.5 * m.rate * t) * p.across;
}

// Necking: v = s (L tanh(z / L) a - sech^2(z / L) r / 2). Along the axis sinh(z / L) grows as exp(s t); across it the
// square of r shrinks as the axis is drawn out, by dz / dz_0.
Vec3 necking_field(const MotionSpec& m, const Vec3& x, double) {
  const AxialPlace p = axial(m, x);
  const double z = p.along / m.length;
  return m.rate * (m.length * std::tanh(z) * p.axis - 0.5 / square(std::cosh(z)) * p.across);
}
Vec3 necking_path(const MotionSpec& m, const Vec3& x, double t) {
  const AxialPlace p = axial(m, x);
  const double start = p.along / m.length, growth = std::exp(m.rate * t);
  const double end = std::asinh(growth * std::sinh(start));
  const double drawn_out = growth * std::cosh(start) / std::cosh(end);  // dz / dz_0
  return m.center + m.length * end * p.axis + p.across / std::sqrt(drawn_out);
}

// Hole: r^2 = r_0^2 + q(t), q = R^2 sin^2(pi t / T), so that v = q'(t) / (2 r^2) r. There is no material where r^2 < q:
// there v goes linearly to zero, to be finite.
double hole_area(const MotionSpec& m, double t) { return square(m.length * std::sin(pi * t / m.period)); }
Vec3 hole_field(const MotionSpec& m, const Vec3& x, double t) {
  const Vec3 across = axial(m, x).across;
  const double rate = square(m.length) * pi / m.period * std::sin(2 * pi * t / m.period);
  const double r2 = std::max(across.squaredNorm(), hole_area(m, t));
  return r2 > 0 ? Vec3(0.5 * rate / r2 * across) : Vec3(Vec3::Zero());
}
Vec3 hole_path(const MotionSpec& m, const Vec3& x, double t) {
  const AxialPlace p = axial(m, x);
  const double area = hole_area(m, t);
  if (area == 0) return x;
  const double r2 = p.across.squaredNorm();
  // What is on the axis itself goes in a direction of its own; it is a line, and no particle is without volume.
  if (r2 == 0) return x + std::sqrt(area) * p.axis.unitOrthogonal();
  return m.center + p.along * p.axis + std::sqrt(1 + area / r2) * p.across;
}
double hole_gradient(const MotionSpec& m) { return 10 * pi / m.period; }

// ---- Vortex.

Vec3 vortex_field(const MotionSpec& m, const Vec3& x, double) {
  const double px = pi * x.x(), py = pi * x.y();
  return m.rate * Vec3(-std::sin(px) * std::cos(py), std::cos(px) * std::sin(py), 0);
}
double vortex_gradient(const MotionSpec& m) { return pi * std::abs(m.rate); }

// ---- Deformation [LeVeque 1996; Enright et al. 2002, Eq. 26]; sin 2a = 2 sin a cos a spares half of the sines.

Vec3 deformation_field(const MotionSpec& m, const Vec3& x, double t) {
  const Eigen::Array3d s = (pi * x.array()).sin(), c = (pi * x.array()).cos();
  const Eigen::Array3d sine_of_double = 2 * s * c, s2 = s * s;
  return m.rate * std::cos(pi * t / m.period) *
         Vec3(2 * s2.x() * sine_of_double.y() * sine_of_double.z(), -sine_of_double.x() * s2.y() * sine_of_double.z(),
              -sine_of_double.x() * sine_of_double.y() * s2.z());
}
double deformation_gradient(const MotionSpec& m) { return 4 * pi * std::abs(m.rate); }

struct MotionInfo {
  const char* name;
  Vec3 (*field)(const MotionSpec&, const Vec3&, double);
  Vec3 (*path)(const MotionSpec&, const Vec3&, double);  ///< nullptr: by integration
  double (*gradient)(const MotionSpec&);                 ///< Bound of the derivatives of the field (1/s).
};

constexpr MotionInfo motions[] = {
    {"rotation", rotation_field, rotation_path, rotation_gradient},
    {"translation", translation_field, translation_path, translation_gradient},
    {"shear", shear_field, shear_path, rate_gradient},
    {"stretch", stretch_field, stretch_path, rate_gradient},
    {"necking", necking_field, necking_path, rate_gradient},
    {"hole", hole_field, hole_path, hole_gradient},
    {"vortex", vortex_field, nullptr, vortex_gradient},
    {"deformation", deformation_field, nullptr, deformation_gradient},
};

}  // namespace

std::vector<std::string> motion_names() {
  std::vector<std::string> names;
  for (const MotionInfo& motion : motions) names.emplace_back(motion.name);
  return names;
}

Motion::Motion(const MotionSpec& spec) : spec_(spec) {
  for (const MotionInfo& motion : motions) {
    if (spec.type != motion.name) continue;
    field_ = motion.field;
    path_ = motion.path;
    gradient_ = motion.gradient;
  }
  if (!field_) {
    throw InputError("particles.motion.type: there is no motion \"" + spec.type + "\"" +
                     did_you_mean(spec.type, motion_names()));
  }
}

Vec3 Motion::velocity(const Vec3& position, double time) const {
  return local_velocity(position - time * spec_.velocity, time) + spec_.velocity;
}

double Motion::integration_step() const {
  // With RK4 the error of a step is about (step * gradient)^5 / 120.
  const double gradient = gradient_(spec_);
  return gradient > 0 ? 0.02 / gradient : 1.0;
}

}  // namespace flowskin::scenes
