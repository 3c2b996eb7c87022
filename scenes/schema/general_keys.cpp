// The scene as a whole, its particles, and what it writes.
#include "scenes/schema/schema.h"

namespace flowskin::scenes {

void add_general_keys(KeyTable& table, Scene& scene) {
  table.text("name", scene.name, "Name of the scene, for messages and titles.");
  table.text("description", scene.description, "What the scene shows.");
  table.natural("seed", scene.seed, "Seed of all random numbers.");
  table.integer("frames", scene.frames, 0, 1000000, "", "Frames after the first one, which is frame 0 at time 0.");
  table.number("frame_rate", scene.frame_rate, at_least(1e-9, 1e5), "1/s", "Frames per second.");
}

void add_output_keys(KeyTable& table, OutputSpec& output) {
  table.boolean("output.obj", output.obj, "Write the surface as OBJ.");
  table.boolean("output.ply", output.ply, "Write the surface as PLY.");
  table.boolean("output.vtp", output.vtp, "Write the surface as VTP.");
  table.boolean("output.particles", output.particles, "Write the particles.");
  table.boolean("output.video", output.video, "Make videos, where ffmpeg is installed.");
  table.choice<Checks>(
      "output.checks", output.checks, {{"every", Checks::every}, {"some", Checks::some}, {"none", Checks::none}},
      "Which frames are compared with a fresh extraction, for frames.csv: all, every tenth from frame 0 on, none. A "
      "comparison takes about half as long as tracking the frame.");
  table.integer("output.checkpoint_interval", output.checkpoint_interval, 0, 1000000, "frames",
                "How often the state is saved, for --resume; also when the run is interrupted. 0: never.");
}

void add_scene_keys(KeyTable& table, Scene& scene) {
  add_general_keys(table, scene);
  add_particle_keys(table, scene);
  add_solver_keys(table, scene);
  add_object_keys(table, scene);
  add_tracking_keys(table, scene.tracking);
  add_texture_keys(table, scene.texture);
  add_render_keys(table, scene.render);
  add_output_keys(table, scene.output);
}

}  // namespace flowskin::scenes
