// Walls and their motion.
#include "scenes/schema/schema.h"

namespace flowskin::scenes {

namespace {

void add_keyframe_keys(KeyTable& table, sph::Keyframe& key) {
  table.number("time", key.time, at_least(-1e6, 1e6), "s", "Later than that of the keyframe before.").is_required();
  table.vector("translate", key.translate, "m", "Translation, applied last.");
  table.vector("rotate", key.rotate, "degrees",
               "Rotation about x, then y, then z, about the pivot; a single angle may grow over many turns.");
}

}  // namespace

void add_boundary_keys(KeyTable& table, BoundarySpec& spec) {
  using Interpolation = sph::BoundaryMotion::Interpolation;
  sph::Boundary& boundary = spec.boundary;
  add_placement_keys(table, spec.mesh);
  table.number("slip", boundary.slip, at_least(0, 1), "",
               "0: no slip, 1: free slip; between: the share of wall friction taken away.");
  table.number("adhesion", boundary.adhesion, at_least(0, 2), "",
               "Attraction of the fluid, with surface tension: contact angle 180 degrees at 0, 90 at 0.5, 0 at 1.");
  table.boolean(
      "hollow", boundary.hollow,
      "Whether the inside of a closed mesh may hold fluid; if not, fluid that would begin there is left out.");
  table.vector("surface_velocity", boundary.surface_velocity, "m/s",
               "Velocity of the surface along the wall, as of a conveyor belt.", 1e4);
  table.list("keyframes", boundary.motion.keyframes, add_keyframe_keys, "Motion of the wall; empty: it rests.");
  table.choice<Interpolation>("interpolation", boundary.motion.interpolation,
                              {{"linear", Interpolation::linear}, {"smooth", Interpolation::smooth}},
                              "Between keyframes: linear, at constant speed, or smooth, from rest to rest.");
  table.vector("pivot", boundary.motion.pivot, "m",
               "Point that the keyframes rotate about, in the place of the mesh without them.");
  table.boolean("visible", spec.visible, "Whether it is drawn in the pictures.");
  table.color("color", spec.color, "Reflectance in the pictures.");
}

}  // namespace flowskin::scenes
