// The opening of an emitter: which part of a plane it is, and the lattice of particles that fills it.
#pragma once

#include <vector>

#include "sph/setup/simulation_setup.h"

namespace flowskin::sph {

/// A disc, a rectangle, or the shadow of a mesh along the direction of the jet.
class EmitterOutlet {
 public:
  /// @throws SettingsError where the shape is impossible or too small for one particle; `name` says whose it is
  EmitterOutlet(const Emitter& emitter, double spacing, const std::string& name);

  const Vec3& center() const { return center_; }  ///< m; a point of the outlet's plane
  const Vec3& axis() const { return axis_; }      ///< unit vector
  double area() const { return area_; }           ///< m^2
  /// Radius of a ball about the centre that holds the outlet (m).
  double reach() const { return reach_; }
  /// Particles of a layer, from the centre (m): a lattice stretched such that each stands for area() / count.
  const std::vector<Vec3>& offsets() const { return offsets_; }
  /// Leaves out the offsets for which `leaves(offset)` holds; the outlet stays as large as it is.
  template <class Leaves>
  void leave_out(const Leaves& leaves) {
    std::erase_if(offsets_, leaves);
  }
  /// Whether a point's foot on the plane lies in the outlet or nearer than `margin` (m) to it. Meshes: tested in eight
  /// directions.
  bool contains(const Vec3& p, double margin) const;

 private:
  static void check_size(double width, double height, double spacing, const std::string& name);
  void make_disc(const Emitter& emitter, double spacing);
  void make_rectangle(const Emitter& emitter, double spacing);
  void make_shadow(const Emitter& emitter, double spacing, const std::string& name);
  bool in_shape(double u, double v, double margin) const;
  bool in_shadow(double u, double v) const;
  void add_lattice_point(double u, double v) { offsets_.emplace_back(u * across_ + v * up_); }
  void stretch_to_area(double spacing);

  Emitter::Shape shape_;
  Vec3 center_, axis_, across_, up_;  // across_ and up_ span the plane
  double area_ = 0, reach_ = 0;
  double half_width_ = 0, half_height_ = 0;  // m; disc: both the radius
  std::vector<Vec3> offsets_;
  // Raster of the shadow, cells of size cell_ from (-half_width_, -half_height_) on.
  double cell_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<char> raster_;
};

}  // namespace flowskin::sph
