// What the writers and the renderer see of one frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/sources/particle_source.h"
#include "tracking/mesh/surface_mesh.h"

namespace flowskin::scenes {

using Vec2f = Eigen::Vector2f;
/// Red, green, blue, sRGB-encoded, 0 to 255.
using Color = std::array<std::uint8_t, 3>;

/// A surface dressed for output: all vertex arrays have one entry per vertex.
struct SurfaceFrame {
  double time = 0;  ///< s
  tracking::SurfaceMesh mesh;
  std::vector<Vec3> normals;                     ///< unit, outward
  std::vector<Color> colors;                     ///< of the rest position
  std::vector<Vec2f> vertex_uvs;                 ///< texture coordinates per vertex (no seams: see corner_uvs)
  std::vector<std::array<Vec2f, 3>> corner_uvs;  ///< texture coordinates per triangle corner
  /// A second texture for stretched places, or the solid one where there are no second coordinates; all may be empty.
  std::vector<float> texture_blend;               ///< its share per vertex, 0 to 1
  std::vector<Vec2f> vertex_uvs2;                 ///< its coordinates per vertex
  std::vector<std::array<Vec2f, 3>> corner_uvs2;  ///< its coordinates per triangle corner
  std::vector<Vec2f> confidence;  ///< how well the field determines the velocity: weak, strong direction; or empty
  std::string texture_file;       ///< image's name beside the written files, for PLY readers; may be empty
};

/// Particles dressed for output.
struct ParticleFrame {
  ParticleState state;
  std::vector<Color> colors;  ///< of the rest position
  double radius = 0;          ///< m, for drawing
};

}  // namespace flowskin::scenes
