// A folder that goes away, and small frames dressed by the program.
#pragma once

#include "tests/scenes/io_fixture.h"
#include "tools/frame_data.h"
#include "tools/textures/texture_mapping.h"

namespace flowskin::tools {

using scenes::IoTest;
using scenes::message_of;
using scenes::sphere_mesh;

inline SurfaceFrame sphere_frame(int level = 2, const std::string& mapping = "box") {
  const tracking::SurfaceMesh mesh = sphere_mesh(level);
  scenes::TextureSpec texture;
  texture.mapping = mapping;
  return dress(mesh, 0.1, texture, rest_frame(mesh.rest_positions));
}

inline ParticleFrame particle_frame(int count) {
  const scenes::ParticleState state = scenes::particle_frame(count).state;
  return dress(state, 0.02, rest_frame(state.rest_positions));
}

}  // namespace flowskin::tools
