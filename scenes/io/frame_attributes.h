// The one table of what vertices and particles carry in files: the writers of PLY and VTP, the reader of PLY and the
// checks before writing all follow it. How a value is written follows from its type.
#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "scenes/io/frames.h"

namespace flowskin::scenes {

/// An attribute's names in files.
struct FileAttribute {
  /// Its components; more names than components: they are written again.
  std::vector<std::string_view> ply;
  std::string_view vtp;
  int vtp_place;            ///< In the order of VTP's arrays, from 1; 0: among the points.
  std::string_view plural;  ///< For messages.
  bool optional = false;    ///< May be empty: then it is not in the file.
  bool of_mesh = false;     ///< A surface read back has it.
};

/// Calls visit(attribute, values) for each attribute of a surface's vertices, in the order of PLY.
template <class Frame, class Visit>
void for_each_surface_attribute(Frame& frame, const Visit& visit) {
  using A = FileAttribute;
  const bool optional = true, of_mesh = true;
  visit(A{{"x", "y", "z"}, "Points", 0, "positions", false, of_mesh}, frame.mesh.positions);
  visit(A{{"nx", "ny", "nz"}, "Normals", 1, "normals"}, frame.normals);
  // Twice, since some programs know the coordinates as s and t, others as texture_u and texture_v.
  visit(A{{"s", "t", "texture_u", "texture_v"}, "TCoords", 2, "texture coordinates"}, frame.vertex_uvs);
  visit(A{{"red", "green", "blue"}, "color", 3, "colours"}, frame.colors);
  visit(A{{"vx", "vy", "vz"}, "velocity", 4, "velocities", false, of_mesh}, frame.mesh.velocities);
  visit(A{{"rest_x", "rest_y", "rest_z"}, "rest_position", 5, "rest positions", false, of_mesh},
        frame.mesh.rest_positions);
  visit(A{{"id"}, "id", 6, "ids", false, of_mesh}, frame.mesh.ids);
  visit(A{{"confidence", "confidence_strong"}, "confidence", 7, "confidences", optional}, frame.confidence);
  visit(A{{"s2", "t2", "texture_u2", "texture_v2"}, "TCoords2", 8, "second texture coordinates", optional},
        frame.vertex_uvs2);
  visit(A{{"texture_blend"}, "texture_blend", 9, "texture blend weights", optional}, frame.texture_blend);
}

/// The same for particles.
template <class Frame, class Visit>
void for_each_particle_attribute(Frame& frame, const Visit& visit) {
  using A = FileAttribute;
  const bool optional = true;
  visit(A{{"x", "y", "z"}, "Points", 0, "positions"}, frame.state.positions);
  visit(A{{"vx", "vy", "vz"}, "velocity", 2, "velocities"}, frame.state.velocities);
  visit(A{{"density"}, "density", 4, "densities"}, frame.state.densities);
  visit(A{{"rest_x", "rest_y", "rest_z"}, "rest_position", 3, "rest positions"}, frame.state.rest_positions);
  visit(A{{"id"}, "id", 7, "ids"}, frame.state.ids);
  visit(A{{"red", "green", "blue"}, "color", 1, "colours"}, frame.colors);
  visit(A{{"fluid"}, "fluid", 5, "fluids", optional}, frame.state.fluids);
  visit(A{{"viscosity"}, "viscosity", 6, "viscosities", optional}, frame.state.viscosities);
}

template <class Visit>
void for_each_file_attribute(const SurfaceFrame& frame, const Visit& visit) {
  for_each_surface_attribute(frame, visit);
}
template <class Visit>
void for_each_file_attribute(const ParticleFrame& frame, const Visit& visit) {
  for_each_particle_attribute(frame, visit);
}

/// Calls visit(attribute, values) for what is written of a frame as VTP's arrays, in their order; the points are not
/// among them.
template <class Frame, class Visit>
void for_each_vtp_array(const Frame& frame, const Visit& visit) {
  constexpr int last_place = 9;
  for (int place = 1; place <= last_place; ++place) {
    for_each_file_attribute(frame, [&](const FileAttribute& attribute, const auto& values) {
      if (attribute.vtp_place == place && !(attribute.optional && values.empty())) visit(attribute, values);
    });
  }
}

}  // namespace flowskin::scenes
