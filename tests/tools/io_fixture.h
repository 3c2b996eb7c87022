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
  scenes::ParticleState state;
  state.time = 1.0 / 3;
  for (int i = 0; i < count; ++i) {
    state.ids.push_back(static_cast<std::uint64_t>(2 * i + 7));
    state.positions.emplace_back(0.1 * i, std::sin(i), -1e-6 * i);
    state.velocities.emplace_back(std::cos(i), -0.0, 1.0 / (i + 1));
    state.rest_positions.emplace_back(0.1 * i, 1.0 / 3, 0.7);
    state.densities.push_back(1000 + i / 7.0);
  }
  return dress(state, 0.02, rest_frame(state.rest_positions));
}

}  // namespace flowskin::tools
