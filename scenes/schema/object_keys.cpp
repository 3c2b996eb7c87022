// The objects of a scene: fluids, bodies, emitters and sinks; where its lists of them stand.
#include <fmt/format.h>

#include "scenes/schema/schema.h"

namespace flowskin::scenes {

namespace {

template <class Shape>
Condition shape_is(const Shape& shape, Shape wanted, const char* name) {
  return {fmt::format("shape \"{}\"", name), [&shape, wanted] { return shape == wanted; }};
}

void add_box_keys(KeyTable& table, sph::Box& box) {
  table.vector("min", box.min, "m", "Lower corner.").is_required();
  table.vector("max", box.max, "m", "Upper corner.").is_required();
}

// Where a body or a sink is: a box, which each calls by a name of its own, a ball or a mesh.
template <class Object>
void add_solid_keys(KeyTable& table, Object& object, typename Object::Shape box_shape, const char* box_name,
                    sph::Box& box, MeshPlacement& placement, std::string_view meaning) {
  using Shape = typename Object::Shape;
  const Condition is_box = shape_is(object.shape, box_shape, box_name);
  const Condition is_ball = shape_is(object.shape, Shape::ball, "ball");
  const Condition is_mesh = shape_is(object.shape, Shape::mesh, "mesh");
  table
      .choice<Shape>("shape", object.shape, {{box_name, box_shape}, {"ball", Shape::ball}, {"mesh", Shape::mesh}},
                     meaning)
      .is_required()
      .selecting();
  std::size_t first = table.keys().size();
  add_box_keys(table, box);
  table.restrict_from(first, is_box);
  table.vector("center", object.center, "m", "Centre.").is_required().only_for(is_ball);
  table.number("radius", object.radius, above(0, 1e5), "m", "Radius.").is_required().only_for(is_ball);
  first = table.keys().size();
  add_placement_keys(table, placement);
  table.restrict_from(first, is_mesh);
}

}  // namespace

void add_placement_keys(KeyTable& table, MeshPlacement& mesh) {
  table.text("file", mesh.file, "Mesh (OBJ), relative to the scene file.").is_required();
  table.scale("scale", mesh.scale, "Factors along x, y and z, applied first.");
  table.vector("rotate", mesh.rotate, "degrees", "Rotation about x, then y, then z, applied after the scale.");
  table.vector("translate", mesh.translate, "m", "Translation, applied last.");
}

void add_rheology_keys(KeyTable& table, const std::string& prefix, sph::Rheology& rheology) {
  using sph::range_of;
  using sph::Rheology;
  table.number(prefix + "consistency", rheology.consistency, range_of(&Rheology::consistency), "Pa s^n",
               "Consistency K of Herschel and Bulkley's law; 0: density times viscosity, with flow_index 1.");
  table.number(prefix + "flow_index", rheology.flow_index, range_of(&Rheology::flow_index), "",
               "Flow index n: below 1 the fluid is thinner, above 1 thicker when sheared. Counts with consistency.");
  table.number(prefix + "yield_stress", rheology.yield_stress, range_of(&Rheology::yield_stress), "Pa",
               "Stress below which the fluid hardly flows.");
  table.number(prefix + "regularization", rheology.regularization, range_of(&Rheology::regularization), "s",
               "Papanastasiou's m: the fluid yields above shear rates of about 1/m.");
  table.number(prefix + "max_viscosity", rheology.max_viscosity, range_of(&Rheology::max_viscosity), "m^2/s",
               "Greatest kinematic viscosity, that of fluid which does not yield.");
}

void add_fluid_keys(KeyTable& table, sph::Fluid& fluid) {
  table.text("name", fluid.name, "By which bodies and emitters refer to it.").is_required();
  table.number("viscosity", fluid.viscosity, sph::range_of(&sph::SolverSettings::viscosity), "m^2/s",
               "Kinematic viscosity: water 1e-6, honey 5e-3.");
  add_rheology_keys(table, "rheology.", fluid.rheology);
}

void add_body_keys(KeyTable& table, BodySpec& spec) {
  sph::FluidBody& body = spec.body;
  add_solid_keys(table, body, sph::FluidBody::Shape::block, "block", body.block, spec.mesh, "Shape of the body.");
  table.list("cuts", body.cuts, add_box_keys, "Boxes that stay empty: slots, hollows.");
  table.vector("velocity", body.velocity, "m/s", "Initial velocity.", 1e4);
  table.vector("angular_velocity", body.angular_velocity, "rad/s", "Initial spin about the body's centroid.", 1e4);
  table.text("fluid", body.fluid, "Name of its fluid; empty: the first one.");
}

void add_emitter_keys(KeyTable& table, EmitterSpec& spec) {
  using Shape = sph::Emitter::Shape;
  sph::Emitter& emitter = spec.emitter;
  const Condition disc = shape_is(emitter.shape, Shape::disc, "disc");
  const Condition rectangle = shape_is(emitter.shape, Shape::rectangle, "rectangle");
  const Condition mesh = shape_is(emitter.shape, Shape::mesh, "mesh");
  const Condition plain{"shape \"disc\" or \"rectangle\"", [&emitter] { return emitter.shape != Shape::mesh; }};
  table
      .choice<Shape>("shape", emitter.shape,
                     {{"disc", Shape::disc}, {"rectangle", Shape::rectangle}, {"mesh", Shape::mesh}},
                     "Shape of the outlet.")
      .selecting();
  table.vector("center", emitter.center, "m", "Centre of the outlet.").is_required().only_for(plain);
  table.vector("direction", emitter.direction, "", "Direction of the jet; its length does not matter.");
  table.number("radius", emitter.radius, above(0, 1e5), "m", "Radius of the disc.").is_required().only_for(disc);
  table.number("width", emitter.width, above(0, 1e5), "m", "Edge across up.").is_required().only_for(rectangle);
  table.number("height", emitter.height, above(0, 1e5), "m", "Edge along up.").is_required().only_for(rectangle);
  table
      .vector("up", emitter.up, "",
              "Direction of the edge height, made perpendicular to the jet; zero: z for jets along y, else y.")
      .only_for(rectangle);
  const std::size_t first = table.keys().size();
  add_placement_keys(table, spec.mesh);
  table.restrict_from(first, mesh);
  table.number("speed", emitter.speed, above(0, 1e4), "m/s", "Speed of the jet.").is_required();
  table.number("start", emitter.start, at_least(0, 1e30), "s", "Time at which it begins to pour.");
  table.number("stop", emitter.stop, at_least(0, 1e30), "s", "Time at which it stops.");
  table.natural("max_particles", emitter.max_particles,
                "Most particles that it pours, in whole layers; 0: any number.");
  table.text("fluid", emitter.fluid, "Name of its fluid; empty: the first one.");
}

void add_sink_keys(KeyTable& table, SinkSpec& spec) {
  sph::Sink& sink = spec.sink;
  add_solid_keys(table, sink, sph::Sink::Shape::box, "box", sink.box, spec.mesh, "Shape of the region.");
  table.number("start", sink.start, at_least(0, 1e30), "s", "Time at which it opens.");
  table.number("stop", sink.stop, at_least(0, 1e30), "s", "Time at which it closes.");
}

void add_object_keys(KeyTable& table, Scene& scene) {
  using Source = ParticlesSpec::Source;
  const Source& source = scene.particles.source;
  const Condition simulated{"particles.source \"simulation\"", [&source] { return source == Source::simulation; }};
  const Condition not_recorded{"particles.source \"simulation\" or \"prescribed\"",
                               [&source] { return source != Source::recorded; }};
  table.list("bodies", scene.bodies, add_body_keys, "Shapes filled with particles at the start.")
      .only_for(not_recorded);
  table.list("emitters", scene.emitters, add_emitter_keys, "Outlets that pour fluid.").only_for(simulated);
  table.list("sinks", scene.sinks, add_sink_keys, "Regions that remove the fluid which comes into them.")
      .only_for(simulated);
  table.list("boundaries", scene.boundaries, add_boundary_keys, "Walls: open or closed surfaces.");
}

}  // namespace flowskin::scenes
