// The tracker: straight into its settings. Lengths stay in spacings here; settings_in_metres() converts them.
#include "scenes/schema/schema.h"
#include "scenes/settings_in_metres.h"

namespace flowskin::scenes {

namespace {

using tracking::SmallParts;

std::vector<std::string> method_names() {
  std::vector<std::string> names{automatic_velocity};
  for (const tracking::VelocityMethodInfo& method : tracking::velocity_methods()) names.push_back(method.name);
  return names;
}

}  // namespace

void add_tracking_keys(KeyTable& table, TrackingSpec& tracking) {
  table.boolean("tracking.enabled", tracking.enabled, "Whether a surface is tracked at all.");
  table.name(
      "tracking.velocity", tracking.velocity, method_names(),
      "Method that gives the velocity of the surface; auto: hybrid for particles with velocities, affine for those "
      "without.",
      "auto, or the name of a velocity method (flowskin methods lists them)");
  table.choice("tracking.integrator", tracking.integrator, tracking::kIntegratorNames,
               "Time integration of the vertices.");
  table.integer("tracking.steps_per_frame", tracking.steps_per_frame, 1, 10000, "",
                "Particle states per frame, one step of the tracker each.");
  table.number("tracking.max_motion", tracking.max_motion, above(0, 10), "effective radii",
               "Farthest that a particle moves in a substep of the tracker.");
  table.number("tracking.radius", tracking.field.radius, at_least(0.5, 10), "spacings",
               "Effective radius of a particle.");
  table.number("tracking.threshold", tracking.field.threshold, at_least(0, 1000), "",
               "Threshold T of the field; 0: the one that puts a flat surface half a spacing outside the particles.");
  table.number(
      "tracking.wall_share", tracking.field.wall_share, at_least(0, 0.5), "thresholds",
      "Field on a bare wall: with it thin films on walls have a surface; 0: the field knows particles alone, as "
      "in the paper.");
  table.number("tracking.edge_length", tracking.edge_length, at_least(0.05, 20), "spacings",
               "Edge length of an extracted mesh.");
  table.number(
      "tracking.curvature_edges", tracking.curvature_edges, at_least(0, 100), "radii of curvature",
      "Edges are at most so long where the surface is sharply curved, down to half of edge_length; 0: all alike.");
  table.number("tracking.smallest_part", tracking.smallest_part, at_least(0, 1e9), "cubic spacings",
               "Parts of fluid, and enclosed air, of a smaller volume are small; 0: none is.");
  table.choice<SmallParts>(
      "tracking.small_parts", tracking.small_parts,
      {{"keep", SmallParts::keep}, {"drop", SmallParts::drop}, {"balls", SmallParts::balls}},
      "What becomes of small parts: they stay as they are, are left out, or become balls of the same volume.");
  table.integer("tracking.fairing_iterations", tracking.fairing_iterations, 0, 10000, "",
                "Iterations of fairing a step.");
  table.number("tracking.fairing_stiffness", tracking.fairing_stiffness, at_least(0, 1), "",
               "Share of the way to the equilibrium of the springs that an iteration goes.");
  table.choice<FairingMaterial>(
      "tracking.fairing_material", tracking.fairing_material,
      {{"auto", FairingMaterial::automatic}, {"kept", FairingMaterial::kept}, {"dragged", FairingMaterial::dragged}},
      "kept: a vertex that slides along the surface takes the material of its new place; dragged: it carries its "
      "material along, as in the paper; auto: kept with hybrid, simulation and affine, dragged with the others, whose "
      "velocities are too rough to go without the smoothing.");
  table.choice<bool>("tracking.fairing_springs", tracking.variable_springs, {{"constant", false}, {"variable", true}},
                     "constant: as in the paper; variable: soft where the field determines the velocity well.");
  table.boolean("tracking.confidence", tracking.confidence,
                "Write with each vertex how well the field alone determines its velocity (0 to 1).");
  table.boolean(
      "tracking.remeshing", tracking.remeshing,
      "Split, collapse and flip edges of a stretching surface; false: a mesh of constant triangles, as in the "
      "paper.");
  table.number(
      "tracking.max_slip", tracking.max_slip, at_least(-1, 1000), "spacings",
      "How far the texture may slip off the particles' material; 0: any distance; negative: 1 where an emitter "
      "pours or the motion is prescribed, else any distance, as particles of a simulation mix and would make "
      "noise of the texture.");
  table.boolean(
      "tracking.topology", tracking.topology,
      "Let the surface merge, split, open and close with the fluid: regions that no longer fit are replaced.");
  table.boolean("tracking.guard", tracking.guard,
                "As a last resort, where regions cannot be replaced, replace the whole surface by a fresh one.");
}

}  // namespace flowskin::scenes
