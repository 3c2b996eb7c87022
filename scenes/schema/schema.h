// All keys of the scene file, bound straight to the settings of solver, tracker and program.
#pragma once

#include "scenes/scene.h"
#include "scenes/schema/key_table.h"

namespace flowskin::scenes {

/// All keys in the order of the file. The table refers to `scene`, which must stay where it is.
void add_scene_keys(KeyTable& table, Scene& scene);

// Its sections.
void add_general_keys(KeyTable& table, Scene& scene);
void add_particle_keys(KeyTable& table, Scene& scene);
void add_solver_keys(KeyTable& table, Scene& scene);
/// Lists of bodies, emitters, sinks and walls.
void add_object_keys(KeyTable& table, Scene& scene);
void add_tracking_keys(KeyTable& table, TrackingSpec& tracking);
void add_texture_keys(KeyTable& table, TextureSpec& texture);
void add_render_keys(KeyTable& table, RenderSpec& render);
void add_output_keys(KeyTable& table, OutputSpec& output);

// The objects in lists.
void add_fluid_keys(KeyTable& table, sph::Fluid& fluid);
void add_body_keys(KeyTable& table, BodySpec& body);
void add_emitter_keys(KeyTable& table, EmitterSpec& emitter);
void add_sink_keys(KeyTable& table, SinkSpec& sink);
void add_boundary_keys(KeyTable& table, BoundarySpec& boundary);

// Groups of keys that several objects have.
/// Those that place a mesh file.
void add_placement_keys(KeyTable& table, MeshPlacement& mesh);
/// A viscosity that depends on the shear rate.
void add_rheology_keys(KeyTable& table, const std::string& prefix, sph::Rheology& rheology);

}  // namespace flowskin::scenes
