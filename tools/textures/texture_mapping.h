// Texture coordinates and colours as functions of the rest position.
#pragma once

#include "scenes/scene.h"
#include "tools/frame_data.h"

namespace flowskin::tools {

/// Size and place of the fluid at rest, which the mapping refers to.
struct RestFrame {
  Vec3 center = Vec3::Zero();  ///< m
  double size = 1;             ///< Longest edge of the bounding box of the rest positions at the start (m).
  double height = 0;           ///< Its extent along y (m), for colours; 0: size.

  template <class Archive>
  void visit(Archive& archive) {
    archive(center, size, height);
  }
};

RestFrame rest_frame(const std::vector<Vec3>& rest_positions);
/// As a scene says it.
inline RestFrame rest_frame_of(const scenes::TextureSpec& texture) { return {texture.rest_center, texture.rest_size}; }

/// Texture coordinates per triangle corner. box: the axis that the triangle faces at rest; spherical: the seam is
/// closed by continuing u past 1 on the triangles that cross it.
/// @param places of the vertices' material (m) that count as at rest
std::vector<std::array<Vec2f, 3>> corner_uvs(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places,
                                             const scenes::TextureSpec& texture, const RestFrame& rest);
/// One pair of coordinates per vertex, for formats that have no more.
std::vector<Vec2f> vertex_uvs(const tracking::SurfaceMesh& mesh, const std::vector<Vec3>& places,
                              const scenes::TextureSpec& texture, const RestFrame& rest);
/// The same from rest positions.
std::vector<std::array<Vec2f, 3>> corner_uvs(const tracking::SurfaceMesh& mesh, const scenes::TextureSpec& texture,
                                             const RestFrame& rest);
std::vector<Vec2f> vertex_uvs(const tracking::SurfaceMesh& mesh, const scenes::TextureSpec& texture,
                              const RestFrame& rest);

/// A colour of the rest position that tells neighbouring material apart, for particles and solid surfaces alike.
Color rest_color(const Vec3& rest_position, const RestFrame& rest);

/// Normals, colours and texture coordinates added.
SurfaceFrame dress(const tracking::SurfaceMesh& mesh, double time, const scenes::TextureSpec& texture,
                   const RestFrame& rest);
ParticleFrame dress(const scenes::ParticleState& state, double spacing, const RestFrame& rest);

}  // namespace flowskin::tools
