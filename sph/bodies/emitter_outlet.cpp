#include "sph/bodies/emitter_outlet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/number_text.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

constexpr double cells_per_spacing = 16;  // of the raster
constexpr double most_cells = 4e6;

// The edge `height` of a rectangle: the one asked for, else along z for jets that go up or down and along y for others.
Vec3 up_of(const Emitter& emitter, const Vec3& axis) {
  Vec3 up = emitter.up;
  if (up.isZero(0)) up = std::abs(axis.y()) > 0.9 ? Vec3::UnitZ() : Vec3::UnitY();
  return up - up.dot(axis) * axis;
}

}  // namespace

EmitterOutlet::EmitterOutlet(const Emitter& emitter, double spacing, const std::string& name) : shape_(emitter.shape) {
  if (!(emitter.direction.norm() > 0)) throw SettingsError(name + ": its direction must not be zero");
  axis_ = emitter.direction.normalized();
  center_ = emitter.center;
  const Vec3 helper = std::abs(axis_.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitZ();
  across_ = (helper - helper.dot(axis_) * axis_).normalized();
  up_ = axis_.cross(across_);
  if (shape_ == Emitter::Shape::disc) {
    if (!(emitter.radius > 0)) throw SettingsError(name + ": its radius must be greater than 0");
    check_size(2 * emitter.radius, 2 * emitter.radius, spacing, name);
    make_disc(emitter, spacing);
  } else if (shape_ == Emitter::Shape::rectangle) {
    if (!(emitter.width > 0 && emitter.height > 0)) {
      throw SettingsError(name + ": its width and height must be greater than 0");
    }
    check_size(emitter.width, emitter.height, spacing, name);
    const Vec3 up = up_of(emitter, axis_);
    if (!(up.norm() > 1e-6 * emitter.up.norm())) throw SettingsError(name + ": its up must not be along its direction");
    up_ = up.normalized();
    across_ = up_.cross(axis_);
    make_rectangle(emitter, spacing);
  } else {
    make_shadow(emitter, spacing, name);
  }
  if (offsets_.empty()) {
    throw SettingsError(name +
                        ": it is too small for a particle at this spacing: make it larger or the spacing smaller");
  }
}

// Before memory is taken for a layer of particles in the box around the outlet.
void EmitterOutlet::check_size(double width, double height, double spacing, const std::string& name) {
  constexpr double most = 1e7;
  const double count = (width / spacing + 1) * (height / spacing + 1);
  if (count <= most) return;
  throw SettingsError(name + ": a layer of its outlet, " + number_text(width, 4) + " m by " + number_text(height, 4) +
                      " m, holds about " + number_text(count, 4) + " particles at a spacing of " +
                      number_text(spacing, 4) + " m; at most " + number_text(most, 4) +
                      " are possible: make the outlet smaller or the spacing larger");
}

// Of the square lattices with a point or the middle of a cell at the centre, the one closer to the disc's area.
void EmitterOutlet::make_disc(const Emitter& emitter, double spacing) {
  const double radius = emitter.radius;
  half_width_ = half_height_ = reach_ = radius;
  area_ = M_PI * radius * radius;
  const double wanted = area_ / (spacing * spacing);
  const int reach = static_cast<int>(std::ceil(radius / spacing)) + 1;
  std::vector<Vec3> best;
  for (const double shift : {0.0, 0.5}) {
    offsets_.clear();
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        const double u = spacing * (i + shift), v = spacing * (j + shift);
        if (u * u + v * v <= radius * radius) add_lattice_point(u, v);
      }
    }
    const auto miss = [&](const std::vector<Vec3>& p) { return std::abs(static_cast<double>(p.size()) - wanted); };
    if (best.empty() || miss(offsets_) < miss(best)) best = offsets_;
  }
  offsets_ = std::move(best);
  stretch_to_area(spacing);
}

void EmitterOutlet::make_rectangle(const Emitter& emitter, double spacing) {
  half_width_ = 0.5 * emitter.width;
  half_height_ = 0.5 * emitter.height;
  reach_ = std::hypot(half_width_, half_height_);
  area_ = emitter.width * emitter.height;
  const auto count = [&](double edge) { return std::max(1, static_cast<int>(std::lround(edge / spacing))); };
  const int columns = count(emitter.width), rows = count(emitter.height);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      add_lattice_point(emitter.width * ((i + 0.5) / columns - 0.5), emitter.height * ((j + 0.5) / rows - 0.5));
    }
  }
}

void EmitterOutlet::make_shadow(const Emitter& emitter, double spacing, const std::string& name) {
  if (emitter.mesh.triangles.empty()) throw SettingsError(name + ": its mesh has no triangles");
  Vec3 low = Vec3::Constant(1e300), high = -low;  // along across_, up_, axis_
  Eigen::Matrix3d frame;
  frame << across_.transpose(), up_.transpose(), axis_.transpose();
  for (const auto& t : emitter.mesh.triangles) {
    for (const int v : t) {
      const Vec3 p = frame * emitter.mesh.positions[static_cast<std::size_t>(v)];
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  half_width_ = 0.5 * (high.x() - low.x());
  half_height_ = 0.5 * (high.y() - low.y());
  reach_ = std::hypot(half_width_, half_height_);
  // In the middle of the shadow, where the mesh is foremost.
  const Vec3 middle(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), high.z());
  center_ = frame.transpose() * middle;

  check_size(2 * half_width_, 2 * half_height_, spacing, name);
  cell_ = std::max(spacing / cells_per_spacing, std::sqrt(4 * half_width_ * half_height_ / most_cells));
  columns_ = static_cast<int>(2 * half_width_ / cell_) + 1;
  rows_ = static_cast<int>(2 * half_height_ / cell_) + 1;
  raster_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  for (const auto& t : emitter.mesh.triangles) {
    Eigen::Vector2d c[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = frame * emitter.mesh.positions[static_cast<std::size_t>(t[k])] - middle;
      c[k] = (p.head<2>() + Eigen::Vector2d(half_width_, half_height_)) / cell_;
    }
    const auto side = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double u, double v) {
      return (b.x() - a.x()) * (v - a.y()) - (b.y() - a.y()) * (u - a.x());
    };
    const double turn = side(c[0], c[1], c[2].x(), c[2].y());
    if (turn == 0) continue;
    const Eigen::Vector2d from = c[0].cwiseMin(c[1]).cwiseMin(c[2]), to = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const int j_end = std::min(rows_ - 1, static_cast<int>(to.y())),
              i_end = std::min(columns_ - 1, static_cast<int>(to.x()));
    for (int j = std::max(0, static_cast<int>(from.y())); j <= j_end; ++j) {
      for (int i = std::max(0, static_cast<int>(from.x())); i <= i_end; ++i) {
        const double u = i + 0.5, v = j + 0.5;
        const bool inside = side(c[0], c[1], u, v) * turn >= 0 && side(c[1], c[2], u, v) * turn >= 0 &&
                            side(c[2], c[0], u, v) * turn >= 0;
        if (inside)
          raster_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)] = 1;
      }
    }
  }
  area_ = cell_ * cell_ * static_cast<double>(std::count(raster_.begin(), raster_.end(), 1));

  const int columns = static_cast<int>(half_width_ / spacing) + 1, rows = static_cast<int>(half_height_ / spacing) + 1;
  for (int i = -columns; i <= columns; ++i) {
    for (int j = -rows; j <= rows; ++j) {
      const double u = spacing * (i + 0.5), v = spacing * (j + 0.5);
      if (in_shadow(u, v)) add_lattice_point(u, v);
    }
  }
  stretch_to_area(spacing);
}

void EmitterOutlet::stretch_to_area(double spacing) {
  const double factor = std::sqrt(area_ / (spacing * spacing * static_cast<double>(offsets_.size())));
  for (Vec3& offset : offsets_) offset *= factor;
}

bool EmitterOutlet::in_shadow(double u, double v) const {
  const double i = (u + half_width_) / cell_, j = (v + half_height_) / cell_;
  if (!(i >= 0 && j >= 0 && i < columns_ && j < rows_)) return false;
  return raster_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)] != 0;
}

bool EmitterOutlet::in_shape(double u, double v, double margin) const {
  if (shape_ == Emitter::Shape::disc) return u * u + v * v <= (half_width_ + margin) * (half_width_ + margin);
  if (!(std::abs(u) <= half_width_ + margin && std::abs(v) <= half_height_ + margin)) return false;
  if (shape_ == Emitter::Shape::rectangle) return true;
  if (in_shadow(u, v)) return true;
  for (int k = 0; k < 8; ++k) {
    if (in_shadow(u + margin * std::cos(k * M_PI / 4), v + margin * std::sin(k * M_PI / 4))) return true;
  }
  return false;
}

bool EmitterOutlet::contains(const Vec3& p, double margin) const {
  const Vec3 d = p - center_;
  return in_shape(d.dot(across_), d.dot(up_), margin);
}

}  // namespace flowskin::sph
